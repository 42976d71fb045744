// Each mistake in a table must be reported with the file and, where there is one, the
// line.

#include <fstream>
#include <iostream>

#include <mitre/base/exceptions.h>
#include <mitre/base/time_table.h>

using namespace mitre::base;

void
try_to_read(const std::string &text, const TimeTable::Extension extension)
{
  {
    std::ofstream file("table.csv");
    file << text;
  }
  try
    {
      const TimeTable table("table.csv", extension);
      table.column("flow");
      std::cout << "no error" << std::endl;
    }
  catch (const UserError &error)
    {
      // without the long list of units
      const std::string message = error.what();
      std::cout << message.substr(0, message.find(" Known: 1,")) << std::endl;
    }
}

int
main()
{
  const auto clamped        = TimeTable::Extension::clamped;
  const auto periodic       = TimeTable::Extension::periodic;
  const std::string heading = "time [s],flow [mL/s]\n";
  try_to_read(heading + "0,1\n0.1,2\n0.1,3\n", clamped);
  try_to_read(heading + "0,1\n0.1,2,3\n", clamped);
  try_to_read(heading + "0,1\n\n0.1,two\n", clamped);
  try_to_read(heading + "0,1\n0.1,\n", clamped);
  try_to_read(heading + "0,1\n", clamped);
  try_to_read("", clamped);
  try_to_read("time,flow\n0,1\n", clamped);
  try_to_read("flow [mL/s],time [s]\n0,1\n", clamped);
  try_to_read("time [s],flow [ml/s]\n0,1\n1,2\n", clamped);
  try_to_read("time [s],pressure [mmHg]\n0,1\n1,2\n", clamped);
  try_to_read(heading + "0,1\n1,2\n", periodic);
  try_to_read(heading + "0,1\n1,1\n", periodic);
  try
    {
      std::ofstream("table.csv") << heading << "0,1\n1,2\n";
      const TimeTable table("table.csv", clamped);
      std::cout << table.column("flow", "flow") << std::endl;
      table.column("flow", "pressure");
    }
  catch (const UserError &error)
    {
      std::cout << error.what() << std::endl;
    }
  try
    {
      TimeTable("missing.csv", clamped);
    }
  catch (const UserError &error)
    {
      std::cout << error.what() << std::endl;
    }
}
