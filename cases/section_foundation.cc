#include "cases/section_foundation.h"

#include "continuum/foundation.h"
#include "continuum/section_mesh.h"

namespace antiform::cases
{
continuum::BoundaryIds foundation_faces(const Parameters &p)
{
  continuum::BoundaryIds faces;
  if (p.has_foundation_under("base"))
    faces.insert(continuum::boundary::bottom);
  if (p.has_foundation_under("top"))
    faces.insert(continuum::boundary::top);
  return faces;
}

continuum::BoundaryIds absorbing_faces(const Parameters &p)
{
  continuum::BoundaryIds faces;
  if (p.is_absorbing("base"))
    faces.insert(continuum::boundary::bottom);
  if (p.is_absorbing("top"))
    faces.insert(continuum::boundary::top);
  return faces;
}

dealii::TrilinosWrappers::SparseMatrix
section_foundation(const Parameters &p, const continuum::DisplacementSpace &solid)
{
  const continuum::BoundaryIds faces = foundation_faces(p);
  dealii::TrilinosWrappers::SparseMatrix springs =
      continuum::winkler_foundation(solid, faces, p.foundation_stiffness());
  if (p.foundation.shear_ratio > 0.)
    springs.add(1., continuum::pasternak_foundation(solid, faces, p.foundation_shear()));
  return springs;
}
} // namespace antiform::cases
