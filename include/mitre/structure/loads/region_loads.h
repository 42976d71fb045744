#ifndef mitre_structure_loads_region_loads_h
#define mitre_structure_loads_region_loads_h

#include <mitre/structure/loads/load.h>

namespace mitre::structure
{
  /// What loads on the elements of a region share.
  template <int dim>
  class VolumeLoad : public Load<dim>
  {
  public:
    void initialize(const Mesh<dim> &) override
    {
    }

    void reinit(const Mesh<dim> &mesh, const ElementSet<dim> &elements) override
    {
      volume.reinit(mesh, elements);
    }

    unsigned int n_elements() const override
    {
      return volume.n_elements();
    }

  protected:
    VolumeRegion<dim> volume;
  };


  /// What loads on the faces of a region share.
  template <int dim>
  class SurfaceLoad : public Load<dim>
  {
  public:
    void initialize(const Mesh<dim> &mesh) override
    {
      surface.initialize(mesh);
    }

    void reinit(const Mesh<dim> &mesh, const ElementSet<dim> &elements) override
    {
      surface.reinit(mesh, elements);
    }

    unsigned int n_elements() const override
    {
      return surface.n_faces();
    }

  protected:
    SurfaceRegion<dim> surface;
  };
} // namespace mitre::structure

#endif
