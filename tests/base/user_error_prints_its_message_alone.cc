// what() of a UserError must be the message and nothing else, whether it is thrown
// plainly or by AssertThrow, which records file, line and stack trace in it; and it must
// be caught as deal.II's and as the standard library's exception.

#include <exception>
#include <iostream>

#include <mitre/base/exceptions.h>

using mitre::base::UserError;

int
main()
{
  try
    {
      throw UserError("mesh 'a.msh': no such file");
    }
  catch (const std::exception &error)
    {
      std::cout << error.what() << std::endl;
    }

  try
    {
      const int n_elements = 0;
      AssertThrow(n_elements > 0, UserError("mesh 'b.msh' has no elements"));
    }
  catch (const dealii::ExceptionBase &error)
    {
      std::cout << error.what() << std::endl;
    }
}
