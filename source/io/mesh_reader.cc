#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>
#include <unordered_map>

#include <mitre/base/exceptions.h>
#include <mitre/io/mesh_reader.h>

namespace mitre::io
{
  namespace
  {
    using structure::ElementShape;

    /// Of materials, which are 32-bit numbers.
    constexpr unsigned int largest_id = 2147483647;

    /// What a number of gmsh's list of element types means, as far as it matters here.
    struct ElementType
    {
      unsigned int dimension;
      unsigned int n_nodes;
      ElementShape shape;
      unsigned int degree; // 0: a type that is neither simplex nor hypercube
      const char *name;
    };

    const std::map<unsigned int, ElementType> &element_types()
    {
      static const std::map<unsigned int, ElementType> types = {
        {1, {1, 2, ElementShape::simplex, 1, "line"}},
        {2, {2, 3, ElementShape::simplex, 1, "triangle"}},
        {3, {2, 4, ElementShape::hypercube, 1, "quadrilateral"}},
        {4, {3, 4, ElementShape::simplex, 1, "tetrahedron"}},
        {5, {3, 8, ElementShape::hypercube, 1, "hexahedron"}},
        {6, {3, 6, ElementShape::simplex, 0, "prism"}},
        {7, {3, 5, ElementShape::simplex, 0, "pyramid"}},
        {8, {1, 3, ElementShape::simplex, 2, "second-order line"}},
        {9, {2, 6, ElementShape::simplex, 2, "second-order triangle"}},
        {10, {2, 9, ElementShape::hypercube, 2, "second-order quadrilateral"}},
        {11, {3, 10, ElementShape::simplex, 2, "second-order tetrahedron"}},
        {12, {3, 27, ElementShape::hypercube, 2, "second-order hexahedron"}},
        {15, {0, 1, ElementShape::simplex, 1, "point"}}};
      return types;
    }


    /// Reads a text word by word and counts lines.
    class Scanner
    {
    public:
      Scanner(std::string text, const std::string &source)
        : text(std::move(text))
        , position(this->text.c_str())
        , source(source)
      {
      }

      [[noreturn]] void fail(const std::string &message) const
      {
        throw base::UserError("Mesh file " + source + ", line " + std::to_string(line) +
                              ": " + message);
      }

      bool at_end()
      {
        skip_blanks();
        return *position == '\0';
      }

      std::string word()
      {
        skip_blanks();
        const char *begin = position;
        while (*position != '\0' &&
               std::isspace(static_cast<unsigned char>(*position)) == 0)
          ++position;
        return std::string(begin, position);
      }

      std::string rest_of_line()
      {
        const char *begin = position;
        while (*position != '\0' && *position != '\n')
          ++position;
        return std::string(begin, position);
      }

      double number(const std::string &what)
      {
        skip_blanks();
        char *end;
        const double value = std::strtod(position, &end);
        if (end == position || !std::isfinite(value))
          fail("expected " + what + ", found '" + word() + "'.");
        position = end;
        return value;
      }

      unsigned long integer(const std::string &what)
      {
        skip_blanks();
        char *end;
        const long value = std::strtol(position, &end, 10);
        if (end == position || value < 0)
          fail("expected " + what + ", found '" + word() + "'.");
        position = end;
        return value;
      }

      /// A text in quotes.
      std::string quoted(const std::string &what)
      {
        skip_blanks();
        if (*position != '"')
          fail("expected " + what + " in quotes, found '" + word() + "'.");
        const char *begin = ++position;
        while (*position != '\0' && *position != '"' && *position != '\n')
          ++position;
        const std::string result(begin, position);
        if (*position == '"')
          ++position;
        return result;
      }

      void expect(const std::string &expected)
      {
        const std::string found = word();
        if (found != expected)
          fail("expected " + expected + ", found '" + found + "'.");
      }

    private:
      void skip_blanks()
      {
        while (std::isspace(static_cast<unsigned char>(*position)) != 0)
          {
            if (*position == '\n')
              ++line;
            ++position;
          }
      }

      const std::string text;
      const char *position;
      const std::string source;
      unsigned long line = 1;
    };


    /// The file as it is, before a choice is made of what it contains.
    struct RawMesh
    {
      std::unordered_map<unsigned long, unsigned int> node_of_tag;
      std::vector<std::array<double, 3>> nodes;

      std::vector<unsigned long> element_tags;
      std::vector<unsigned int> element_types;
      std::vector<unsigned int> material_ids;
      std::vector<unsigned int> first_node; // in element_nodes
      std::vector<unsigned int> element_nodes;

      std::map<std::string, std::unordered_map<unsigned long, std::array<double, 3>>>
        element_data;
    };


    void add_node(Scanner &scanner, RawMesh &raw, const unsigned long tag)
    {
      std::array<double, 3> x;
      for (double &coordinate : x)
        coordinate = scanner.number("a coordinate");
      if (!raw.node_of_tag.emplace(tag, raw.nodes.size()).second)
        scanner.fail("the node number " + std::to_string(tag) + " occurs twice.");
      raw.nodes.push_back(x);
    }


    const ElementType &find_type(const Scanner &scanner, const unsigned long type)
    {
      const auto found = element_types().find(type);
      if (found == element_types().end())
        scanner.fail(
          "elements of gmsh's type " + std::to_string(type) +
          " are not known; expected are tetrahedra, hexahedra, triangles or "
          "quadrilaterals of first order, or of second order with 10, 27, 6 or "
          "9 nodes.");
      return found->second;
    }


    void add_element(Scanner &scanner,
                     RawMesh &raw,
                     const unsigned long tag,
                     const unsigned long type,
                     const unsigned long material_id)
    {
      raw.element_tags.push_back(tag);
      raw.element_types.push_back(type);
      raw.material_ids.push_back(material_id);
      raw.first_node.push_back(raw.element_nodes.size());
      for (unsigned int a = 0; a < find_type(scanner, type).n_nodes; ++a)
        {
          const unsigned long node_tag = scanner.integer("a node number");
          const auto node              = raw.node_of_tag.find(node_tag);
          if (node == raw.node_of_tag.end())
            scanner.fail("element " + std::to_string(tag) + " has the node " +
                         std::to_string(node_tag) + ", which the file does not have.");
          raw.element_nodes.push_back(node->second);
        }
    }


    void scan_format_2(Scanner &scanner, RawMesh &raw, const std::string &section)
    {
      const unsigned long n = scanner.integer("a number of entries");
      if (section == "$Nodes")
        for (unsigned long i = 0; i < n; ++i)
          {
            const unsigned long tag = scanner.integer("a node number");
            add_node(scanner, raw, tag);
          }
      else
        for (unsigned long i = 0; i < n; ++i)
          {
            const unsigned long tag    = scanner.integer("an element number");
            const unsigned long type   = scanner.integer("an element type");
            const unsigned long n_tags = scanner.integer("a number of tags");
            unsigned long material_id  = 0;
            for (unsigned long k = 0; k < n_tags; ++k)
              {
                const unsigned long value = scanner.integer("a tag");
                if (k == 0 && value > largest_id)
                  scanner.fail("physical ids are at most " + std::to_string(largest_id) +
                               ", found " + std::to_string(value) + ".");
                if (k == 0)
                  material_id = value;
              }
            add_element(scanner, raw, tag, type, material_id);
          }
    }


    /// In format 4.1 physical ids belong to entities, given by dimension and tag.
    using PhysicalIds = std::map<std::pair<unsigned long, unsigned long>, unsigned int>;


    void scan_entities(Scanner &scanner, PhysicalIds &physical_ids)
    {
      std::array<unsigned long, 4> n_entities;
      for (unsigned long &n : n_entities)
        n = scanner.integer("a number of entities");
      for (unsigned int dimension = 0; dimension < 4; ++dimension)
        for (unsigned long i = 0; i < n_entities[dimension]; ++i)
          {
            const unsigned long tag = scanner.integer("an entity");
            for (unsigned int k = 0; k < (dimension == 0 ? 3u : 6u); ++k)
              scanner.number("a coordinate");
            const unsigned long n_ids = scanner.integer("a number of physical ids");
            for (unsigned long k = 0; k < n_ids; ++k)
              {
                // negative where the entity is turned round
                const double id = std::abs(scanner.number("a physical id"));
                if (id > largest_id)
                  scanner.fail("physical ids are at most " + std::to_string(largest_id) +
                               ".");
                if (k == 0)
                  physical_ids[{dimension, tag}] = static_cast<unsigned int>(id);
              }
            if (dimension > 0)
              {
                const unsigned long n_bounding =
                  scanner.integer("a number of bounding entities");
                for (unsigned long k = 0; k < n_bounding; ++k)
                  scanner.number("an entity");
              }
          }
    }


    void scan_format_4(Scanner &scanner,
                       RawMesh &raw,
                       const PhysicalIds &physical_ids,
                       const std::string &section)
    {
      const unsigned long n_blocks = scanner.integer("a number of blocks");
      for (unsigned int k = 0; k < 3; ++k)
        scanner.integer("a number of entries");

      for (unsigned long block = 0; block < n_blocks; ++block)
        {
          const unsigned long dimension = scanner.integer("a dimension");
          const unsigned long entity    = scanner.integer("an entity");
          const unsigned long third     = scanner.integer("an element type");
          const unsigned long n         = scanner.integer("a number of entries");
          if (section == "$Nodes")
            {
              if (third != 0)
                scanner.fail("parametric nodes are not supported.");
              // One by one, as a damaged file may tell of more than there is memory.
              std::vector<unsigned long> tags;
              for (unsigned long i = 0; i < n; ++i)
                tags.push_back(scanner.integer("a node number"));
              for (const unsigned long tag : tags)
                add_node(scanner, raw, tag);
            }
          else
            {
              const auto id = physical_ids.find({dimension, entity});
              for (unsigned long i = 0; i < n; ++i)
                {
                  const unsigned long tag = scanner.integer("an element number");
                  add_element(
                    scanner, raw, tag, third, id == physical_ids.end() ? 0 : id->second);
                }
            }
        }
    }


    void scan_element_data(Scanner &scanner, RawMesh &raw)
    {
      const unsigned long n_strings = scanner.integer("a number of names");
      std::string name;
      for (unsigned long i = 0; i < n_strings; ++i)
        {
          const std::string text = scanner.quoted("a name");
          if (i == 0)
            name = text;
        }
      const unsigned long n_reals = scanner.integer("a number of times");
      for (unsigned long i = 0; i < n_reals; ++i)
        scanner.number("a time");
      const unsigned long n_integers = scanner.integer("a number of integers");
      std::vector<unsigned long> integers;
      for (unsigned long i = 0; i < n_integers; ++i)
        integers.push_back(scanner.integer("an integer"));
      if (integers.size() < 3)
        scanner.fail("$ElementData needs time step, number of components and number of "
                     "elements.");

      const bool fibres = name == "fibre" || name == "fibre 2";
      if (fibres && integers[1] != 3)
        scanner.fail("$ElementData \"" + name + "\" has " + std::to_string(integers[1]) +
                     " components an element; expected are 3.");
      for (unsigned long i = 0; i < integers[2]; ++i)
        {
          const unsigned long tag         = scanner.integer("an element number");
          std::array<double, 3> direction = {};
          for (unsigned long c = 0; c < integers[1]; ++c)
            {
              const double value = scanner.number("a component");
              if (c < 3)
                direction[c] = value;
            }
          if (fibres)
            raw.element_data[name][tag] = direction;
        }
    }


    RawMesh scan(Scanner &scanner)
    {
      RawMesh raw;
      PhysicalIds physical_ids;
      double version = 0;
      while (!scanner.at_end())
        {
          const std::string section = scanner.word();
          if (section.empty() || section[0] != '$')
            scanner.fail("expected the start of a section such as $Nodes, found '" +
                         section + "'.");
          if (section == "$MeshFormat")
            {
              version = scanner.number("a version");
              if (scanner.integer("0 for ASCII") != 0)
                scanner.fail("the file is binary; save it as ASCII (gmsh: "
                             "-format msh22, without -bin).");
              scanner.integer("a data size");
              if (std::abs(version - 4.1) > 1e-6 && std::floor(version) != 2)
                scanner.fail("format version " + std::to_string(version) +
                             " is not supported; save the mesh as 2.2 or 4.1 (gmsh: "
                             "-format msh22).");
            }
          else if (version == 0)
            scanner.fail("expected $MeshFormat, found '" + section + "'.");
          else if (section == "$Entities")
            scan_entities(scanner, physical_ids);
          else if (section == "$Nodes" || section == "$Elements")
            {
              if (version < 3)
                scan_format_2(scanner, raw, section);
              else
                scan_format_4(scanner, raw, physical_ids, section);
            }
          else if (section == "$ElementData")
            scan_element_data(scanner, raw);
          else
            {
              const std::string end = "$End" + section.substr(1);
              std::string word;
              while (!scanner.at_end() && (word = scanner.word()) != end)
                {
                }
              if (word != end)
                scanner.fail("the section " + section + " does not end.");
              continue;
            }
          scanner.expect("$End" + section.substr(1));
        }
      return raw;
    }


    /// The nodes of a gmsh cell in deal.II's order: gmsh's number of each.
    template <int dim>
    std::vector<unsigned int> node_order(const ElementShape shape,
                                         const unsigned int degree)
    {
      if (shape == ElementShape::simplex)
        {
          if (degree == 1)
            return dim == 2 ? std::vector<unsigned int>{0, 1, 2}
                            : std::vector<unsigned int>{0, 1, 2, 3};
          return dim == 2 ? std::vector<unsigned int>{0, 1, 2, 3, 4, 5}
                          : std::vector<unsigned int>{0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
        }
      if (degree == 1)
        return dim == 2 ? std::vector<unsigned int>{0, 1, 3, 2}
                        : std::vector<unsigned int>{0, 1, 3, 2, 4, 5, 7, 6};
      return dim == 2 ? std::vector<unsigned int>{0, 1, 3, 2, 7, 5, 4, 6, 8}
                      : std::vector<unsigned int>{0,  1,  3,  2,  4,  5,  7,  6,  9,
                                                  11, 8,  13, 17, 18, 16, 19, 10, 12,
                                                  15, 14, 22, 23, 21, 24, 20, 25, 26};
    }


    template <int dim>
    structure::Mesh<dim> read_with_deal_ii(const std::string &file)
    {
      dealii::Triangulation<dim> triangulation;
      try
        {
          dealii::GridIn<dim> reader(triangulation);
          reader.read(file);
        }
      catch (const std::exception &error)
        {
          throw base::UserError("Mesh file " + file +
                                " cannot be read as a mesh of a format that its name "
                                "stands for: " +
                                error.what());
        }
      const dealii::ReferenceCell type = triangulation.get_reference_cells().front();
      AssertThrow(triangulation.get_reference_cells().size() == 1 &&
                    (type.is_simplex() || type.is_hyper_cube()),
                  base::UserError("Mesh file " + file +
                                  " must have simplices or hypercubes only."));

      structure::Mesh<dim> mesh;
      mesh.source = file;
      mesh.shape  = type.is_simplex() ? ElementShape::simplex : ElementShape::hypercube;
      mesh.nodes_per_element = type.n_vertices();
      mesh.nodes             = triangulation.get_vertices();
      for (const auto &cell : triangulation.active_cell_iterators())
        {
          for (const unsigned int v : cell->vertex_indices())
            mesh.elements.push_back(cell->vertex_index(v));
          mesh.material_ids.push_back(cell->material_id());
        }
      return mesh;
    }


    template <typename T>
    void broadcast(std::vector<T> &values, const MPI_Comm communicator)
    {
      static_assert(std::is_trivially_copyable<T>::value, "sent as bytes");
      std::uint64_t n = values.size();
      MPI_Bcast(&n, 1, MPI_UINT64_T, 0, communicator);
      values.resize(n);
      constexpr std::uint64_t chunk = 1u << 24;
      for (std::uint64_t begin = 0; begin < n; begin += chunk)
        MPI_Bcast(values.data() + begin,
                  static_cast<int>(std::min(chunk, n - begin) * sizeof(T)),
                  MPI_BYTE,
                  0,
                  communicator);
    }
  } // namespace


  template <int dim>
  structure::Mesh<dim> read_msh(std::istream &in, const std::string &source)
  {
    // Step 1: the text.
    const std::string text(std::istreambuf_iterator<char>(in), {});
    AssertThrow(
      text.find('\0') == std::string::npos,
      base::UserError("Mesh file " + source +
                      ": it has bytes that are 0, as binary files have; save it "
                      "as ASCII (gmsh: -format msh22, without -bin)."));
    Scanner scanner(text, source);
    const RawMesh raw = scan(scanner);

    // Step 2: there must be elements of our dimension, all alike.
    const auto fail = [&](const std::string &message) {
      throw base::UserError("Mesh file " + source + ": " + message);
    };
    std::vector<unsigned int> chosen;
    std::map<unsigned int, std::size_t> n_of_dimension;
    for (unsigned int i = 0; i < raw.element_types.size(); ++i)
      {
        const ElementType &type = element_types().at(raw.element_types[i]);
        ++n_of_dimension[type.dimension];
        if (type.dimension != dim)
          continue;
        if (type.degree == 0)
          fail("element " + std::to_string(raw.element_tags[i]) + " is a " + type.name +
               "; expected are " +
               (dim == 2 ? "triangles or quadrilaterals" : "tetrahedra or hexahedra") +
               " of first or second order.");
        if (!chosen.empty() && raw.element_types[i] != raw.element_types[chosen.front()])
          fail("element " + std::to_string(raw.element_tags[i]) + " is a " + type.name +
               ", element " + std::to_string(raw.element_tags[chosen.front()]) + " a " +
               element_types().at(raw.element_types[chosen.front()]).name +
               "; the elements of a part must have one shape.");
        chosen.push_back(i);
      }
    if (chosen.empty() || n_of_dimension.rbegin()->first > dim)
      {
        std::string found;
        for (const auto &[dimension, n] : n_of_dimension)
          found += (found.empty() ? "" : ", ") + std::to_string(n) + " of dimension " +
                   std::to_string(dimension);
        fail("expected elements of dimension " + std::to_string(dim) + ", found " +
             (found.empty() ? "none" : found) + ".");
      }

    // Step 3: the mesh.
    const ElementType &type = element_types().at(raw.element_types[chosen.front()]);
    structure::Mesh<dim> mesh;
    mesh.source            = source;
    mesh.shape             = type.shape;
    mesh.degree            = type.degree;
    mesh.nodes_per_element = type.n_nodes;

    constexpr unsigned int unused = std::numeric_limits<unsigned int>::max();
    std::vector<unsigned int> new_number(raw.nodes.size(), unused);
    for (const unsigned int i : chosen)
      for (unsigned int a = 0; a < type.n_nodes; ++a)
        new_number[raw.element_nodes[raw.first_node[i] + a]] = 0;
    for (unsigned int i = 0; i < raw.nodes.size(); ++i)
      if (new_number[i] != unused)
        {
          new_number[i] = mesh.nodes.size();
          dealii::Point<dim> x;
          for (unsigned int d = 0; d < dim; ++d)
            x[d] = raw.nodes[i][d];
          if (dim == 2 && raw.nodes[i][2] != 0)
            fail("a node at z = " + std::to_string(raw.nodes[i][2]) +
                 " in a two-dimensional mesh; expected is z = 0.");
          mesh.nodes.push_back(x);
        }
    const std::vector<unsigned int> order = node_order<dim>(type.shape, type.degree);
    for (const unsigned int i : chosen)
      {
        for (const unsigned int a : order)
          mesh.elements.push_back(new_number[raw.element_nodes[raw.first_node[i] + a]]);
        mesh.material_ids.push_back(raw.material_ids[i]);
        mesh.element_tags.push_back(raw.element_tags[i]);
      }

    // Step 4: elements of the surface that have a physical id.
    const unsigned int n_corners =
      type.shape == ElementShape::simplex ? dim : 1u << (dim - 1);
    for (unsigned int i = 0; i < raw.element_types.size(); ++i)
      {
        const ElementType &side    = element_types().at(raw.element_types[i]);
        const bool has_our_corners = dim == 2 || side.shape == type.shape;
        if (side.dimension != dim - 1 || !has_our_corners || raw.material_ids[i] == 0)
          continue;
        const unsigned int *nodes = raw.element_nodes.data() + raw.first_node[i];
        if (std::any_of(nodes, nodes + n_corners, [&](const unsigned int node) {
              return new_number[node] == unused;
            }))
          continue;
        for (unsigned int k = 0; k < n_corners; ++k)
          mesh.boundary_elements.push_back(new_number[nodes[k]]);
        mesh.boundary_ids.push_back(raw.material_ids[i]);
      }

    // Step 5: fibres.
    const char *names[structure::max_fibre_families] = {"fibre", "fibre 2"};
    for (unsigned int f = 0; f < structure::max_fibre_families; ++f)
      {
        const auto data = raw.element_data.find(names[f]);
        if (data == raw.element_data.end())
          continue;
        if (f > 0 && mesh.fibres[f - 1].empty())
          fail("there is \"fibre 2\", but no \"fibre\".");
        std::size_t n_found = 0;
        for (const unsigned long tag : mesh.element_tags)
          {
            dealii::Tensor<1, dim> direction;
            const auto value = data->second.find(tag);
            if (value != data->second.end())
              {
                ++n_found;
                for (unsigned int d = 0; d < dim; ++d)
                  direction[d] = value->second[d];
                if (direction.norm() > 0)
                  direction /= direction.norm();
              }
            mesh.fibres[f].push_back(direction);
          }
        if (n_found != data->second.size())
          fail("the $ElementData \"" + std::string(names[f]) + "\" has " +
               std::to_string(data->second.size()) + " elements, " +
               std::to_string(data->second.size() - n_found) +
               " of which are no elements of dimension " + std::to_string(dim) + ".");
      }

    check_orientation(mesh);
    return mesh;
  }


  template <int dim>
  structure::Mesh<dim> read_mesh(const std::string &file, const MPI_Comm communicator)
  {
    structure::Mesh<dim> mesh;
    std::string error;
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      try
        {
          std::ifstream in(file);
          AssertThrow(in,
                      base::UserError("The mesh file '" + file +
                                      "' cannot be opened for reading."));
          const std::string ending = file.substr(file.find_last_of('.') + 1);
          if (ending == "msh")
            mesh = read_msh<dim>(in, file);
          else
            {
              mesh = read_with_deal_ii<dim>(file);
              check_orientation(mesh);
            }
        }
      catch (const std::exception &exception)
        {
          error = exception.what();
        }

    // The other ranks get the error or the mesh.
    error = dealii::Utilities::MPI::broadcast(communicator, error);
    AssertThrow(error.empty(), base::UserError(error));
    mesh.source = dealii::Utilities::MPI::broadcast(communicator, mesh.source);
    const std::array<unsigned int, 3> kind = dealii::Utilities::MPI::broadcast(
      communicator,
      std::array<unsigned int, 3>{
        {static_cast<unsigned int>(mesh.shape), mesh.degree, mesh.nodes_per_element}});
    mesh.shape             = static_cast<ElementShape>(kind[0]);
    mesh.degree            = kind[1];
    mesh.nodes_per_element = kind[2];

    std::vector<std::array<double, dim>> nodes;
    for (const dealii::Point<dim> &x : mesh.nodes)
      {
        nodes.emplace_back();
        for (unsigned int d = 0; d < dim; ++d)
          nodes.back()[d] = x[d];
      }
    broadcast(nodes, communicator);
    mesh.nodes.resize(nodes.size());
    for (unsigned int i = 0; i < nodes.size(); ++i)
      for (unsigned int d = 0; d < dim; ++d)
        mesh.nodes[i][d] = nodes[i][d];

    broadcast(mesh.elements, communicator);
    broadcast(mesh.material_ids, communicator);
    broadcast(mesh.element_tags, communicator);
    broadcast(mesh.boundary_elements, communicator);
    broadcast(mesh.boundary_ids, communicator);
    for (std::vector<dealii::Tensor<1, dim>> &family : mesh.fibres)
      {
        std::vector<std::array<double, dim>> directions;
        for (const dealii::Tensor<1, dim> &direction : family)
          {
            directions.emplace_back();
            for (unsigned int d = 0; d < dim; ++d)
              directions.back()[d] = direction[d];
          }
        broadcast(directions, communicator);
        family.resize(directions.size());
        for (unsigned int i = 0; i < directions.size(); ++i)
          for (unsigned int d = 0; d < dim; ++d)
            family[i][d] = directions[i][d];
      }
    return mesh;
  }


  template structure::Mesh<2> read_msh(std::istream &, const std::string &);
  template structure::Mesh<3> read_msh(std::istream &, const std::string &);
  template structure::Mesh<2> read_mesh(const std::string &, const MPI_Comm);
  template structure::Mesh<3> read_mesh(const std::string &, const MPI_Comm);
} // namespace mitre::io
