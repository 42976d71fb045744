#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <sstream>
#include <vector>

#include <mitre/base/exceptions.h>
#include <mitre/io/fibre_files.h>
#include <mitre/io/safe_file.h>

namespace mitre::io
{
  namespace
  {
    /// The entries of a file, one by one: words of lines without comments.
    class EntryReader
    {
    public:
      EntryReader(std::istream &in, const std::string &source, const std::string &what)
        : in(in)
        , source(source)
        , what(what)
      {
      }

      [[noreturn]] void fail(const std::string &message) const
      {
        throw base::UserError("Fibre file " + source + ", line " + std::to_string(line_) +
                              ": " + message);
      }

      /// The first line of the file.
      unsigned int read_number_of_entries()
      {
        if (!next_line())
          fail("expected the number of " + what + ", found the end of the file.");
        const unsigned int n = integer("the number of " + what);
        end_of_entry();
        return n;
      }

      /// Go to entry number @p i of @p n.
      void begin_entry(const unsigned int i, const unsigned int n)
      {
        if (!next_line())
          fail("the file ends after " + std::to_string(i) + " " + what +
               "; its first line announces " + std::to_string(n) + ".");
      }

      /// Whether the line has another word.
      bool has_more() const
      {
        return next_word < words.size();
      }

      double number(const std::string &name)
      {
        const std::string word = take("expected " + name);
        char *end;
        const double value = std::strtod(word.c_str(), &end);
        if (*end != '\0' || !std::isfinite(value))
          fail("expected " + name + ", found '" + word + "'.");
        return value;
      }

      double positive_number(const std::string &name)
      {
        const double value = number(name);
        if (value < 0)
          {
            std::ostringstream text;
            text << name << " is " << value << "; it must not be negative.";
            fail(text.str());
          }
        return value;
      }

      unsigned int integer(const std::string &name)
      {
        const std::string word = take("expected " + name);
        char *end;
        const long value = std::strtol(word.c_str(), &end, 10);
        if (*end != '\0' || value < 0 || value > std::numeric_limits<int>::max())
          fail("expected " + name + ", found '" + word + "'.");
        return value;
      }

      unsigned int node(const std::size_t n_nodes)
      {
        const unsigned int i = integer("the index of a node");
        if (i >= n_nodes)
          fail("the node " + std::to_string(i) + " is not there; there are " +
               std::to_string(n_nodes) + ", counted from 0.");
        return i;
      }

      void end_of_entry() const
      {
        if (has_more())
          fail("expected the end of the line, found '" + words[next_word] + "'.");
      }

      void end_of_file(const unsigned int n)
      {
        if (next_line())
          fail("expected the end of the file after " + std::to_string(n) + " " + what +
               ", found '" + words[0] + "'.");
      }

      unsigned long line() const
      {
        return line_;
      }

    private:
      bool next_line()
      {
        std::string text;
        while (std::getline(in, text))
          {
            ++line_;
            std::istringstream stream(text.substr(0, text.find_first_of("!#%")));
            words.assign(std::istream_iterator<std::string>(stream),
                         std::istream_iterator<std::string>());
            next_word = 0;
            if (!words.empty())
              return true;
          }
        ++line_;
        return false;
      }

      std::string take(const std::string &expected)
      {
        if (!has_more())
          fail(expected + ", found the end of the line.");
        return words[next_word++];
      }

      std::istream &in;
      const std::string source, what;
      unsigned long line_ = 0;
      std::vector<std::string> words;
      std::size_t next_word = 0;
    };


    /// Read all entries of a file; @p read takes the words of one.
    void read_entries(std::istream &in,
                      const std::string &source,
                      const std::string &what,
                      const std::function<void(EntryReader &)> &read)
    {
      EntryReader reader(in, source, what);
      const unsigned int n = reader.read_number_of_entries();
      for (unsigned int i = 0; i < n; ++i)
        {
          reader.begin_entry(i, n);
          read(reader);
          reader.end_of_entry();
        }
      reader.end_of_file(n);
    }


    bool is_there(const std::string &file)
    {
      std::error_code ignored;
      return std::filesystem::exists(std::filesystem::symlink_status(file, ignored));
    }


    /// The text of a file on all ranks; @p found says whether there is one. Throws
    /// base::UserError on all ranks if it cannot be read.
    std::string
    read_on_first_rank(const std::string &file, const MPI_Comm communicator, bool &found)
    {
      std::string text;
      found = false;
      call_together(communicator, [&]() {
        if (dealii::Utilities::MPI::this_mpi_process(communicator) != 0)
          return;
        found = is_there(file);
        if (!found)
          return;
        errno = 0;
        std::ifstream in(file);
        if (in)
          text.assign(std::istreambuf_iterator<char>(in),
                      std::istreambuf_iterator<char>());
        AssertThrow(in,
                    base::UserError(
                      "Fibre file " + file + " cannot be read: " +
                      (errno == 0 ? "the system gives no reason" : std::strerror(errno)) +
                      "."));
      });
      found = dealii::Utilities::MPI::broadcast(communicator, found);
      return dealii::Utilities::MPI::broadcast(communicator, text);
    }


    std::string with_ending(const std::string &file, const std::string &ending)
    {
      return std::filesystem::path(file).replace_extension(ending).string();
    }
  } // namespace


  std::map<std::string, std::string> files_beside(const std::string &vertex_file)
  {
    std::map<std::string, std::string> files;
    for (const std::string ending : {".spring", ".beam", ".target"})
      if (const std::string file = with_ending(vertex_file, ending); is_there(file))
        files[ending] = file;
    return files;
  }


  template <int dim>
  void read_vertices(std::istream &in,
                     const std::string &source,
                     structure::FibreNetwork<dim> &network)
  {
    network.source = source;
    network.nodes.clear();
    read_entries(in, source, "nodes", [&](EntryReader &entry) {
      dealii::Point<dim> x;
      for (unsigned int c = 0; c < dim; ++c)
        x[c] = entry.number(std::string("the coordinate ") + "xyz"[c]);
      network.nodes.push_back(x);
    });
    AssertThrow(!network.nodes.empty(),
                base::UserError("Fibre file " + source + " has no nodes."));
  }


  template <int dim>
  void read_springs(std::istream &in,
                    const std::string &source,
                    structure::FibreNetwork<dim> &network)
  {
    network.spring_source = source;
    read_entries(in, source, "springs", [&](EntryReader &entry) {
      structure::Spring spring;
      spring.line = entry.line();
      for (unsigned int &node : spring.nodes)
        node = entry.node(network.nodes.size());
      if (spring.nodes[0] == spring.nodes[1])
        entry.fail("both ends of the spring are the node " +
                   std::to_string(spring.nodes[0]) + ".");
      spring.stiffness = entry.positive_number("the stiffness");
      if (entry.has_more())
        spring.rest_length = entry.positive_number("the rest length");
      if (entry.has_more())
        spring.force_function = entry.integer("the index of a force function");
      while (entry.has_more())
        spring.parameters.push_back(entry.number("a value for the force function"));
      network.springs.push_back(spring);
    });
  }


  template <int dim>
  void read_beams(std::istream &in,
                  const std::string &source,
                  structure::FibreNetwork<dim> &network)
  {
    read_entries(in, source, "beams", [&](EntryReader &entry) {
      structure::Beam<dim> beam;
      for (unsigned int &node : beam.nodes)
        node = entry.node(network.nodes.size());
      const auto &[i, j, k] = beam.nodes;
      if (i == j || j == k || i == k)
        entry.fail("the nodes " + std::to_string(i) + ", " + std::to_string(j) + ", " +
                   std::to_string(k) + " of the beam are not three different ones.");
      beam.stiffness = entry.positive_number("the stiffness");
      if (entry.has_more())
        for (unsigned int c = 0; c < dim; ++c)
          beam.curvature[c] =
            entry.number(std::string("the component ") + "xyz"[c] + " of the curvature");
      network.beams.push_back(beam);
    });
  }


  template <int dim>
  void read_targets(std::istream &in,
                    const std::string &source,
                    structure::FibreNetwork<dim> &network)
  {
    std::vector<bool> is_held(network.nodes.size(), false);
    read_entries(in, source, "target points", [&](EntryReader &entry) {
      structure::TargetPoint target;
      target.node = entry.node(network.nodes.size());
      if (is_held[target.node])
        entry.fail("the node " + std::to_string(target.node) +
                   " is already a target point.");
      is_held[target.node] = true;
      target.stiffness     = entry.positive_number("the stiffness");
      if (entry.has_more())
        target.damping = entry.positive_number("the damping");
      network.targets.push_back(target);
    });
  }


  template <int dim>
  structure::FibreNetwork<dim> read_fibres(const std::string &vertex_file,
                                           const MPI_Comm communicator)
  {
    AssertThrow(std::filesystem::path(vertex_file).extension() == ".vertex",
                base::UserError("Fibre file " + vertex_file +
                                ": expected a name that ends with .vertex."));
    using Read =
      void (*)(std::istream &, const std::string &, structure::FibreNetwork<dim> &);
    const std::vector<std::pair<std::string, Read>> files = {
      {".vertex", &read_vertices<dim>},
      {".spring", &read_springs<dim>},
      {".beam", &read_beams<dim>},
      {".target", &read_targets<dim>}};

    structure::FibreNetwork<dim> network;
    for (const auto &[ending, read] : files)
      {
        const std::string file = with_ending(vertex_file, ending);
        bool found;
        std::istringstream in(read_on_first_rank(file, communicator, found));
        AssertThrow(found || ending != ".vertex",
                    base::UserError("Fibre file " + file + " cannot be opened."));
        if (found)
          read(in, file, network);
      }
    return network;
  }


  template <int dim>
  void write_fibres(const structure::FibreNetwork<dim> &network, const std::string &name)
  {
    const auto write = [&](const std::string &ending,
                           const std::size_t n,
                           const std::function<void(std::ostream &)> &write_entries) {
      const std::string file = name + ending;
      if (n == 0)
        {
          std::error_code ignored;
          std::filesystem::remove(file, ignored);
          return;
        }
      write_file(file, [&](std::ostream &out) {
        out.precision(17);
        out << n << '\n';
        write_entries(out);
      });
    };

    write(".vertex", network.nodes.size(), [&](std::ostream &out) {
      for (const dealii::Point<dim> &x : network.nodes)
        out << x << '\n';
    });
    write(".spring", network.springs.size(), [&](std::ostream &out) {
      for (const structure::Spring &spring : network.springs)
        {
          out << spring.nodes[0] << ' ' << spring.nodes[1] << ' ' << spring.stiffness
              << ' ' << spring.rest_length;
          if (spring.force_function != 0 || !spring.parameters.empty())
            out << ' ' << spring.force_function;
          for (const double value : spring.parameters)
            out << ' ' << value;
          out << '\n';
        }
    });
    write(".beam", network.beams.size(), [&](std::ostream &out) {
      for (const structure::Beam<dim> &beam : network.beams)
        {
          out << beam.nodes[0] << ' ' << beam.nodes[1] << ' ' << beam.nodes[2] << ' '
              << beam.stiffness;
          if (beam.curvature.norm() > 0)
            out << ' ' << beam.curvature;
          out << '\n';
        }
    });
    write(".target", network.targets.size(), [&](std::ostream &out) {
      for (const structure::TargetPoint &target : network.targets)
        {
          out << target.node << ' ' << target.stiffness;
          if (target.damping > 0)
            out << ' ' << target.damping;
          out << '\n';
        }
    });
  }


#define MITRE_INSTANTIATE(dim)                                                           \
  template void read_vertices(                                                           \
    std::istream &, const std::string &, structure::FibreNetwork<dim> &);                \
  template void read_springs(                                                            \
    std::istream &, const std::string &, structure::FibreNetwork<dim> &);                \
  template void read_beams(                                                              \
    std::istream &, const std::string &, structure::FibreNetwork<dim> &);                \
  template void read_targets(                                                            \
    std::istream &, const std::string &, structure::FibreNetwork<dim> &);                \
  template structure::FibreNetwork<dim> read_fibres(const std::string &,                 \
                                                    const MPI_Comm);                     \
  template void write_fibres(const structure::FibreNetwork<dim> &, const std::string &);

  MITRE_INSTANTIATE(2)
  MITRE_INSTANTIATE(3)
#undef MITRE_INSTANTIATE
} // namespace mitre::io
