#ifndef mitre_tests_vtu_file_h
#define mitre_tests_vtu_file_h

// Reads VTU files with compressed arrays, as far as the tests need it.

#include <deal.II/base/utilities.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>
#include <zlib.h>

namespace vtu
{
  inline std::string read_text(const std::string &file_name)
  {
    std::ifstream file(file_name);
    if (!file)
      throw std::runtime_error("There is no file " + file_name);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  /// The value of an attribute, say Name="...", in the text of an element.
  inline std::string attribute(const std::string &element, const std::string &name)
  {
    const std::size_t begin = element.find(name + "=\"");
    if (begin == std::string::npos)
      return "";
    const std::size_t first = begin + name.size() + 2;
    return element.substr(first, element.find('"', first) - first);
  }

  /// All values of an attribute in a text.
  inline std::vector<std::string> attributes(const std::string &text,
                                             const std::string &name)
  {
    std::vector<std::string> values;
    for (std::size_t at = text.find(" " + name + "=\""); at != std::string::npos;
         at             = text.find(" " + name + "=\"", at + 1))
      values.push_back(attribute(text.substr(at), name));
    return values;
  }

  struct File
  {
    explicit File(const std::string &file_name)
    {
      const std::string text = read_text(file_name);
      n_points               = std::stoul(attribute(text, "NumberOfPoints"));
      n_cells                = std::stoul(attribute(text, "NumberOfCells"));
      for (std::size_t at = text.find("<DataArray"); at != std::string::npos;
           at             = text.find("<DataArray", at + 1))
        {
                      const std::size_t end     = text.find('>', at);
                      const std::string element = text.substr(at, end - at);
                      std::string name          = attribute(element, "Name");
                      if (name.empty())
            name = "position";
          std::string content = text.substr(end + 1, text.find('<', end) - end - 1);
                      content.erase(0, content.find_first_not_of(" \n"));
                      content.erase(content.find_last_not_of(" \n") + 1);
                      arrays[name] = decode(attribute(element, "type"), content);
        }
    }

    /// The numbers of an array, of whatever type.
    static std::vector<double> decode(const std::string &type, const std::string &content)
    {
      // a block of four 32-bit numbers takes 24 letters
      const auto header_bytes = dealii::Utilities::decode_base64(content.substr(0, 24));
      std::uint32_t header[4];
      std::memcpy(header, header_bytes.data(), sizeof(header));
      const auto compressed = dealii::Utilities::decode_base64(content.substr(24));
      if (header[0] != 1 || compressed.size() < header[3])
        throw std::runtime_error("not a compressed array");
      std::vector<unsigned char> bytes(header[1]);
      uLongf size = bytes.size();
      if (uncompress(bytes.data(), &size, compressed.data(), header[3]) != Z_OK)
        throw std::runtime_error("cannot uncompress");

      if (type == "Float32")
        return convert<float>(bytes);
      if (type == "Float64")
        return convert<double>(bytes);
      if (type == "Int32")
        return convert<std::int32_t>(bytes);
      if (type == "UInt32")
        return convert<std::uint32_t>(bytes);
      if (type == "UInt8")
        return convert<std::uint8_t>(bytes);
      throw std::runtime_error("unknown type " + type);
    }

    template <typename T>
    static std::vector<double> convert(const std::vector<unsigned char> &bytes)
    {
      std::vector<T> values(bytes.size() / sizeof(T));
      std::memcpy(values.data(), bytes.data(), bytes.size());
      return std::vector<double>(values.begin(), values.end());
    }

    std::size_t n_points, n_cells;
    std::map<std::string, std::vector<double>> arrays;
  };
} // namespace vtu

#endif
