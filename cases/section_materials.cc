#include "cases/section_materials.h"

namespace antiform::cases
{
std::vector<continuum::ElasticMaterial> mesh_materials(const Parameters &p)
{
  using continuum::ElasticMaterial;
  return {ElasticMaterial::isotropic(p.matrix_modulus(), p.matrix.poisson_ratio,
                                     p.matrix_density(), "matrix"),
          ElasticMaterial::isotropic(p.layer.young_modulus, p.layer.poisson_ratio,
                                     p.layer_density(), "layer")};
}
} // namespace antiform::cases
