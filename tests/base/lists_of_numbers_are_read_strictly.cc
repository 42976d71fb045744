// Lists are read member by member; anything that is not a number, a wrong number of
// coordinates, or a fraction among integers, is an error that names the parameter.

#include <iostream>

#include <mitre/base/exceptions.h>
#include <mitre/base/parameters.h>

using namespace mitre::base;

template <typename Function>
void
show_error(const Function &function)
{
  try
    {
      function();
      std::cout << "no error" << std::endl;
    }
  catch (const UserError &error)
    {
      std::cout << error.what() << std::endl;
    }
}

int
main()
{
  for (const double number : parse_numbers(" 1, -2.5 ,3e-2", "a"))
    std::cout << number << ' ';
  for (const int number : parse_integers("4, -5", "a"))
    std::cout << number << ' ';
  std::cout << parse_numbers("", "a").size() << std::endl;
  for (const std::string &name : parse_names(" leaflets , long   name"))
    std::cout << "'" << name << "' ";
  std::cout << std::endl;
  std::cout << parse_point<2>("1, 2", "a") << ", " << parse_point<3>("1,2,3", "a");
  for (const auto &point : parse_points<3>("1, 2, 3; 4, 5, 6", "a"))
    std::cout << ", " << point;
  std::cout << std::endl;

  show_error([] { parse_numbers("1, 2x", "Box"); });
  show_error([] { parse_numbers("1,, 2", "Box"); });
  show_error([] { parse_number("nan", "Box"); });
  show_error([] { parse_integers("1, 2.5", "Material ids"); });
  show_error([] { parse_point<3>("1, 2", "Centre"); });
  show_error([] { parse_points<2>("1, 2; 3", "Stations"); });
}
