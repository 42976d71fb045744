#include <deal.II/base/data_out_base.h>
#include <deal.II/base/utilities.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <zlib.h>

#include <mitre/base/exceptions.h>
#include <mitre/base/units.h>
#include <mitre/grid/cell_halo.h>
#include <mitre/grid/velocity_halo.h>
#include <mitre/io/output.h>
#include <mitre/io/safe_file.h>
#include <mitre/structure/fibre_body.h>

namespace mitre::io
{
  using namespace dealii;

  namespace
  {
    /**
     * Component @p c of the velocity in the corners of a patch's cells (x fastest): the
     * mean of the faces of that component that meet there.
     *
     * @param padded the component with one more layer on each side
     * @param stride between neighbours in the padded array, by direction
     */
    template <int dim>
    void compute_corner_velocity(const std::vector<double> &padded,
                                 const std::array<std::size_t, dim> &stride,
                                 const unsigned int c,
                                 const unsigned int n,
                                 std::vector<double> &corners)
    {
      const unsigned int n_corners = Utilities::fixed_power<dim>(n + 1);
      corners.resize(n_corners);
      for (unsigned int v = 0; v < n_corners; ++v)
        {
          std::size_t first = stride[c];
          unsigned int rest = v;
          for (unsigned int d = 0; d < dim; ++d)
            {
              first += (rest % (n + 1)) * stride[d];
              rest /= n + 1;
            }
          double sum = 0;
          for (unsigned int k = 0; k < (1u << (dim - 1)); ++k)
            {
              std::size_t entry = first;
              unsigned int bit  = 0;
              for (unsigned int d = 0; d < dim; ++d)
                if (d != c)
                  entry += ((k >> bit++) & 1u) * stride[d];
              sum += padded[entry];
            }
          corners[v] = sum / (1u << (dim - 1));
        }
    }


    /**
     * Complete the cells of a patch, padded by one layer across its sides, so that means
     * of neighbours are those of a function that is linear: what lies beyond is moved to
     * one cell width from the centre, extrapolated at the domain's boundary and in the
     * layer's edges and corners.
     */
    template <int dim>
    void complete_cell_layer(const grid::PatchGrid<dim> &patch_grid,
                             const unsigned int p,
                             std::vector<double> &padded)
    {
      const unsigned int n     = patch_grid.n_cells_per_side();
      const unsigned int width = n + 2;

      // Step 1: across the sides. Beyond a side with coarser cells, a cell is next to
      // 2^(dim-1) of the patch, with the mean of which it is compared.
      for (unsigned int side = 0; side < 2 * dim; ++side)
        {
          const grid::Neighbor kind = patch_grid.neighbor(p, side);
          if (kind == grid::Neighbor::same)
            continue;
          const unsigned int d        = side / 2;
          const std::size_t step      = Utilities::pow<std::size_t>(width, d);
          const std::ptrdiff_t inward = (side % 2 == 0 ? 1 : -1) * std::ptrdiff_t(step);
          for (unsigned int face = 0; face < Utilities::fixed_power<dim - 1>(n); ++face)
            {
              // the cell beyond the face, and the first of those that a coarse one meets
              std::size_t beyond = (side % 2 == 0 ? 0 : n + 1) * step;
              std::size_t first  = beyond;
              unsigned int rest  = face;
              for (unsigned int e = 0; e < dim; ++e)
                if (e != d)
                  {
                    const std::size_t step_e = Utilities::pow<std::size_t>(width, e);
                    beyond += (rest % n + 1) * step_e;
                    first += (rest % n / 2 * 2 + 1) * step_e;
                    rest /= n;
                  }
              const double inside = padded[beyond + inward];
              if (kind == grid::Neighbor::boundary)
                padded[beyond] = 2 * inside - padded[beyond + 2 * inward];
              else if (kind == grid::Neighbor::finer)
                padded[beyond] = inside + (padded[beyond] - inside) / 0.75;
              else
                {
                  double mean = 0;
                  for (unsigned int k = 0; k < (1u << (dim - 1)); ++k)
                    {
                      std::size_t cell = first + inward;
                      unsigned int bit = 0;
                      for (unsigned int e = 0; e < dim; ++e)
                        if (e != d)
                          cell +=
                            ((k >> bit++) & 1u) * Utilities::pow<std::size_t>(width, e);
                      mean += padded[cell] / (1u << (dim - 1));
                    }
                  padded[beyond] = inside + (padded[beyond] - mean) / 1.5;
                }
            }
        }

      // Step 2: edges, then corners.
      for (std::size_t i = 0; i < padded.size(); ++i)
        {
          std::array<std::ptrdiff_t, dim> inward;
          std::size_t step        = 1;
          unsigned int n_beyond   = 0;
          std::ptrdiff_t own_cell = i;
          for (unsigned int d = 0; d < dim; ++d)
            {
              const unsigned int layer = (i / step) % width;
              if (layer == 0 || layer == n + 1)
                {
                  inward[n_beyond] = (layer == 0 ? 1 : -1) * std::ptrdiff_t(step);
                  own_cell += inward[n_beyond];
                  ++n_beyond;
                }
              step *= width;
            }
          if (n_beyond < 2)
            continue;
          double value = -(n_beyond - 1.) * padded[own_cell];
          for (unsigned int k = 0; k < n_beyond; ++k)
            value += padded[own_cell - inward[k]];
          padded[i] = value;
        }
    }


    /// The mean of the padded cells around each corner of the patch's cells (x fastest).
    template <int dim>
    void compute_corner_means(const std::vector<double> &padded,
                              const unsigned int n,
                              std::vector<double> &corners)
    {
      const unsigned int n_corners = Utilities::fixed_power<dim>(n + 1);
      corners.resize(n_corners);
      for (unsigned int v = 0; v < n_corners; ++v)
        {
          double sum = 0;
          for (unsigned int k = 0; k < (1u << dim); ++k)
            {
              std::size_t entry = 0, step = 1;
              unsigned int rest = v;
              for (unsigned int d = 0; d < dim; ++d)
                {
                  entry += (rest % (n + 1) + ((k >> d) & 1u)) * step;
                  rest /= n + 1;
                  step *= n + 2;
                }
              sum += padded[entry];
            }
          corners[v] = sum / (1u << dim);
        }
    }


    /// The fluid on the patches of this rank as deal.II's output classes want it.
    template <int dim>
    class FluidOutput : public DataOutInterface<dim>
    {
    public:
      /// Collective.
      FluidOutput(
        const grid::StaggeredSpace<dim> &space,
        const grid::VectorType &u,
        const grid::VectorType &p,
        const std::function<double(const grid::BoundaryTerm<dim> &)> &prescribed)
      {
        const grid::PatchGrid<dim> &patch_grid = space.grid();
        const unsigned int n                   = patch_grid.n_cells_per_side();

        grid::VelocityHalo<dim> velocity_halo(
          space, 1, grid::HaloShape::full, grid::BoundaryExtension::reflection);
        velocity_halo.make_own_partitioner();
        if (prescribed)
          velocity_halo.set_boundary_values(prescribed);
        const grid::VectorType &velocity = velocity_halo.import(u);

        const grid::CellHalo<dim> cell_halo(patch_grid, n);
        grid::VectorType pressure;
        cell_halo.initialize_vector(pressure);
        AssertDimension(pressure.locally_owned_size(), p.locally_owned_size());
        std::copy(p.begin(), p.begin() + p.locally_owned_size(), pressure.begin());
        pressure.update_ghost_values();

        std::vector<double> padded, corners;
        patches.resize(patch_grid.n_owned_patches());
        for (unsigned int q = 0; q < patches.size(); ++q)
          {
            const grid::Patch<dim> &patch      = patch_grid.patch(q);
            DataOutBase::Patch<dim, dim> &data = patches[q];
            data.patch_index                   = q;
            data.n_subdivisions                = n;
            data.reference_cell                = ReferenceCells::get_hypercube<dim>();
            for (unsigned int v = 0; v < (1u << dim); ++v)
              for (unsigned int d = 0; d < dim; ++d)
                data.vertices[v][d] =
                  patch.lower[d] + (((v >> d) & 1u) != 0 ? n * patch.h[d] : 0.);
            data.data.reinit(dim + 2, Utilities::fixed_power<dim>(n + 1));

            for (unsigned int c = 0; c < dim; ++c)
              {
                padded.resize(velocity_halo.size(c));
                velocity_halo.gather(
                  velocity, q, c, padded.data(), static_cast<bool>(prescribed));
                std::array<std::size_t, dim> stride;
                std::size_t step = 1;
                for (unsigned int d = 0; d < dim; ++d)
                  {
                    stride[d] = step;
                    step *= velocity_halo.extents(c)[d];
                  }
                compute_corner_velocity<dim>(padded, stride, c, n, corners);
                for (unsigned int v = 0; v < corners.size(); ++v)
                  data.data(c, v) = corners[v];
              }

            padded.assign(cell_halo.padded_size(), 0.);
            cell_halo.gather(pressure, q, padded.data());
            complete_cell_layer(patch_grid, q, padded);
            compute_corner_means<dim>(padded, n, corners);
            for (unsigned int v = 0; v < corners.size(); ++v)
              {
                data.data(dim, v)     = corners[v] / base::mmHg;
                data.data(dim + 1, v) = patch.level;
              }
          }
      }

    private:
      const std::vector<DataOutBase::Patch<dim, dim>> &get_patches() const override
      {
        return patches;
      }

      std::vector<std::string> get_dataset_names() const override
      {
        std::vector<std::string> names(dim, "velocity");
        names.push_back("pressure [mmHg]");
        names.push_back("level");
        return names;
      }

      std::vector<std::tuple<unsigned int,
                             unsigned int,
                             std::string,
                             DataComponentInterpretation::DataComponentInterpretation>>
      get_nonscalar_data_ranges() const override
      {
        return {
          std::make_tuple(0,
                          dim - 1,
                          "velocity",
                          DataComponentInterpretation::component_is_part_of_vector)};
      }

      std::vector<DataOutBase::Patch<dim, dim>> patches;
    };


    /// A DataArray element of a VTU file: base64 text of one zlib-compressed block.
    template <typename T>
    void write_array(std::ostream &out,
                     const std::string &type,
                     const std::string &name,
                     const unsigned int n_components,
                     const std::vector<T> &values)
    {
      out << "<DataArray type=\"" << type << "\" Name=\"" << name
          << "\" NumberOfComponents=\"" << n_components << "\" format=\"binary\">";

      const std::uint32_t size = values.size() * sizeof(T);
      uLongf compressed_size   = compressBound(size);
      std::vector<unsigned char> compressed(compressed_size);
      const int status = compress2(compressed.data(),
                                   &compressed_size,
                                   reinterpret_cast<const Bytef *>(values.data()),
                                   size,
                                   Z_BEST_SPEED);
      AssertThrow(status == Z_OK, ExcInternalError());
      compressed.resize(compressed_size);

      // number of blocks, size of blocks and of the last one, compressed size
      const std::array<std::uint32_t, 4> header{
        {1, size, size, static_cast<std::uint32_t>(compressed_size)}};
      const auto *bytes = reinterpret_cast<const unsigned char *>(header.data());
      out << Utilities::encode_base64(
               std::vector<unsigned char>(bytes, bytes + sizeof(header)))
          << Utilities::encode_base64(compressed) << "</DataArray>\n";
    }


    /// VTK's number of an element's shape and, in VTK's order, its nodes.
    template <int dim>
    std::pair<unsigned char, std::vector<unsigned int>>
    vtk_cell(const structure::ElementShape shape, const unsigned int degree)
    {
      using Cell = std::pair<unsigned char, std::vector<unsigned int>>;
      if (degree == 2)
        {
          if (shape == structure::ElementShape::simplex)
            return dim == 2 ? Cell(22, {0, 1, 2, 3, 4, 5})
                            : Cell(24, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
          return dim == 2
                   ? Cell(28, {0, 1, 3, 2, 6, 5, 7, 4, 8})
                   : Cell(29, {0,  1,  3,  2,  4,  5,  7,  6,  10, 9,  11, 8,  14, 13,
                               15, 12, 16, 17, 19, 18, 20, 21, 22, 23, 24, 25, 26});
        }
      if (shape == structure::ElementShape::segment)
        return Cell(3, {0, 1});
      if (shape == structure::ElementShape::simplex)
        return dim == 2 ? std::make_pair(5, std::vector<unsigned int>{0, 1, 2})
                        : std::make_pair(10, std::vector<unsigned int>{0, 1, 2, 3});
      return dim == 2
               ? std::make_pair(9, std::vector<unsigned int>{0, 1, 3, 2})
               : std::make_pair(12, std::vector<unsigned int>{0, 1, 3, 2, 4, 5, 7, 6});
    }


    /// Nodal vectors with dim components as ones with three.
    template <int dim>
    std::vector<float> pad_vectors(const std::vector<double> &values)
    {
      std::vector<float> result(values.size() / dim * 3, 0.f);
      for (std::size_t i = 0; i < values.size(); ++i)
        result[i / dim * 3 + i % dim] = values[i];
      return result;
    }


    /// Deformed over reference volume by element; @p X by node and component.
    template <int dim>
    std::vector<float>
    compute_volume_ratios(const structure::FiniteElementBody<dim> &body,
                          const std::vector<double> &X)
    {
      structure::Mesh<dim> deformed = body.mesh();
      for (std::size_t i = 0; i < X.size(); ++i)
        deformed.nodes[i / dim][i % dim] = X[i];
      const structure::ShapeTable<dim> shape(body.reference_element(),
                                             body.reference_element().force_quadrature());
      std::vector<float> ratios(deformed.n_elements());
      for (unsigned int e = 0; e < ratios.size(); ++e)
        {
          double volume = 0, reference_volume = 0;
          for (unsigned int q = 0; q < shape.n_points; ++q)
            {
              volume += shape.weights[q] * determinant(shape.jacobian(deformed, e, q));
              reference_volume +=
                shape.weights[q] * determinant(shape.jacobian(body.mesh(), e, q));
            }
          ratios[e] = volume / reference_volume;
        }
      return ratios;
    }


    /// A field by element.
    struct CellField
    {
      std::string name;
      unsigned int n_components;
      std::vector<float> values;
    };


    /// The fields of a part. Collective.
    template <int dim>
    std::vector<CellField> compute_cell_fields(const structure::Body<dim> &body,
                                               const structure::VectorType &X,
                                               const std::vector<double> &positions,
                                               const double time)
    {
      const auto as_floats = [](const std::vector<double> &values) {
        return std::vector<float>(values.begin(), values.end());
      };
      if (const auto *fibres = dynamic_cast<const structure::FibreBody<dim> *>(&body))
        return {{"tension [dyn]", 1, as_floats(fibres->compute_tensions(positions))}};

      const auto &elements =
        dynamic_cast<const structure::FiniteElementBody<dim> &>(body);
      std::vector<CellField> result = {
        {"J", 1, compute_volume_ratios(elements, positions)}};
      const std::vector<std::string> &names = elements.element_fields();
      const std::vector<std::vector<double>> fields =
        elements.compute_element_fields(names, X, time);
      for (unsigned int k = 0; k < fields.size(); ++k)
        if (names[k] != "J")
          {
            const auto &quantity = structure::find_stress_quantity<dim>(names[k]);
            result.push_back(
              {quantity.name + (quantity.unit.empty() ? "" : " [" + quantity.unit + "]"),
               quantity.n_components,
               as_floats(fields[k])});
          }
      return result;
    }


    /// The VTU file of a part; @p X and @p U by node and component.
    template <int dim>
    void write_body(std::ostream &out,
                    const structure::Body<dim> &body,
                    const std::vector<double> &X,
                    const std::vector<double> &U,
                    const std::vector<CellField> &fields)
    {
      const structure::Mesh<dim> &mesh = body.mesh();
      const auto [type, corners]       = vtk_cell<dim>(mesh.shape, mesh.degree);

      std::vector<double> displacement = X;
      for (std::size_t i = 0; i < X.size(); ++i)
        displacement[i] -= mesh.nodes[i / dim][i % dim];

      std::vector<std::int32_t> connectivity, offsets;
      std::vector<unsigned char> types(mesh.n_elements(), type);
      for (unsigned int e = 0; e < mesh.n_elements(); ++e)
        {
          for (const unsigned int corner : corners)
            connectivity.push_back(mesh.elements[e * mesh.nodes_per_element + corner]);
          // a node by itself
          if (mesh.shape == structure::ElementShape::segment &&
              connectivity.back() == connectivity[connectivity.size() - 2])
            {
              connectivity.pop_back();
              types[e] = 1;
            }
          offsets.push_back(connectivity.size());
        }

      out << "<?xml version=\"1.0\"?>\n"
             "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" "
             "compressor=\"vtkZLibDataCompressor\" byte_order=\"LittleEndian\">\n"
             "<UnstructuredGrid>\n"
          << "<Piece NumberOfPoints=\"" << mesh.nodes.size() << "\" NumberOfCells=\""
          << mesh.n_elements() << "\">\n";
      out << "<Points>\n";
      write_array(out, "Float32", "position", 3, pad_vectors<dim>(X));
      out << "</Points>\n<Cells>\n";
      write_array(out, "Int32", "connectivity", 1, connectivity);
      write_array(out, "Int32", "offsets", 1, offsets);
      write_array(out, "UInt8", "types", 1, types);
      out << "</Cells>\n<PointData Vectors=\"displacement\">\n";
      write_array(out, "Float32", "displacement", 3, pad_vectors<dim>(displacement));
      write_array(out, "Float32", "velocity", 3, pad_vectors<dim>(U));
      out << "</PointData>\n<CellData Scalars=\"" << fields[0].name << "\">\n";
      write_array(out, "Float32", fields[0].name, 1, fields[0].values);
      write_array(
        out,
        "Int32",
        "material id",
        1,
        std::vector<std::int32_t>(mesh.material_ids.begin(), mesh.material_ids.end()));
      for (unsigned int k = 1; k < fields.size(); ++k)
        write_array(
          out, "Float32", fields[k].name, fields[k].n_components, fields[k].values);
      out << "</CellData>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
    }
  } // namespace


  template <int dim>
  OutputWriter<dim>::OutputWriter(const std::string &run_folder,
                                  const MPI_Comm communicator)
    : communicator(communicator)
    , rank(Utilities::MPI::this_mpi_process(communicator))
    , folder(run_folder + "/output/")
  {
    call_together(communicator, [&]() {
      if (rank == 0)
        make_folder(folder);
    });
  }


  template <int dim>
  std::string OutputWriter<dim>::next_frame(const std::string &series) const
  {
    const auto found = frames.find(series);
    return series + "_" +
           Utilities::int_to_string(found == frames.end() ? 0 : found->second.size(), 5);
  }


  template <int dim>
  void OutputWriter<dim>::add_frame(const std::string &series,
                                    const double time,
                                    const std::string &file_name)
  {
    frames[series].emplace_back(time, file_name);
    write_collection(series);
  }


  template <int dim>
  void OutputWriter<dim>::write_collection(const std::string &series) const
  {
    if (rank == 0)
      {
        write_file(folder + series + ".pvd", [&](std::ostream &out) {
          DataOutBase::write_pvd_record(out, frames.at(series));
        });
        unsynchronised.insert(folder + series + ".pvd");
      }
  }


  template <int dim>
  void OutputWriter<dim>::synchronise()
  {
    call_together(communicator, [&]() {
      for (const std::string &file : unsynchronised)
        io::synchronise(file);
      if (!unsynchronised.empty())
        io::synchronise(folder);
      unsynchronised.clear();
    });
  }


  template <int dim>
  void OutputWriter<dim>::continue_after(const Frames &written)
  {
    frames = written;
    call_together(communicator, [&]() {
      for (const auto &[series, list] : frames)
        write_collection(series);
    });
  }


  template <int dim>
  void OutputWriter<dim>::write_fluid(const grid::StaggeredSpace<dim> &space,
                                      const grid::VectorType &u,
                                      const grid::VectorType &p,
                                      const double time,
                                      const PrescribedVelocity &prescribed)
  {
    const std::string frame = next_frame("fluid");
    const auto piece        = [&](const unsigned int r) {
      return frame + "." + std::to_string(r) + ".vtu";
    };

    FluidOutput<dim> output(space, u, p, prescribed);
    DataOutBase::VtkFlags flags;
    flags.print_date_and_time = false;
    flags.compression_level   = DataOutBase::VtkFlags::best_speed;
    output.set_flags(flags);
    call_together(communicator, [&]() {
      write_file(folder + piece(rank), [&](std::ostream &out) { output.write_vtu(out); });
      unsynchronised.insert(folder + piece(rank));
    });

    call_together(communicator, [&]() {
      if (rank == 0)
        {
          std::vector<std::string> pieces;
          for (unsigned int r = 0; r < Utilities::MPI::n_mpi_processes(communicator); ++r)
            pieces.push_back(piece(r));
          write_file(folder + frame + ".pvtu",
                     [&](std::ostream &out) { output.write_pvtu_record(out, pieces); });
          unsynchronised.insert(folder + frame + ".pvtu");
        }
      add_frame("fluid", time, frame + ".pvtu");
    });
  }


  template <int dim>
  void OutputWriter<dim>::write_part(const structure::Body<dim> &body,
                                     const structure::VectorType &X,
                                     const structure::VectorType &U,
                                     const double time)
  {
    AssertThrow(body.name() != "fluid" &&
                  body.name().find_first_of("/\\\"<>&") == std::string::npos,
                base::UserError("Part " + body.name() +
                                ": its output cannot be written to files of that name. "
                                "Choose one other than 'fluid', and without / \\ \" < > "
                                "and &."));
    const std::string file_name = next_frame(body.name()) + ".vtu";

    const std::vector<double> positions  = body.to_mesh_order(X);
    const std::vector<double> velocities = body.to_mesh_order(U);
    const std::vector<CellField> fields  = compute_cell_fields(body, X, positions, time);
    call_together(communicator, [&]() {
      if (rank == 0)
        {
          write_file(folder + file_name, [&](std::ostream &out) {
            write_body(out, body, positions, velocities, fields);
          });
          unsynchronised.insert(folder + file_name);
        }
      add_frame(body.name(), time, file_name);
    });
  }


  template class OutputWriter<2>;
  template class OutputWriter<3>;
} // namespace mitre::io
