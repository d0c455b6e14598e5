// Case 43: a layer under its weight and an axial force is up, free of any push, over a
// length of a base that does not pull. On a rigid base P l^2 = 80.763 D; an elastic one
// lets the layer sink in beside the lifted length over its own length (4 D / k)^(1/4).
#include "continuum/arch_theory.h"
#include "continuum/newton_solver.h"
#include "continuum/unilateral_foundation.h"
#include "support/nonlinear_fixtures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>

namespace upheaval_tests
{
using namespace antiform::continuum;
using namespace antiform::testing;

namespace
{
// Shear takes 0.1 % of the deflection.
const theory::Layer layer{10e9, 0.25, 1.};
constexpr double length = 150.; // l of the theory, and all of a rigid base
const double D = layer.bending_stiffness();
const auto constants = theory::upheaval_constants();
const double axial_force = constants.force * D / (length * length);
// Slopes of 1 % only: the theory's.
const double crest = 0.004 * length;
const double weight = crest * D / (constants.deflection * std::pow(length, 4));

/// Half of the layer, from the crest at x = 0 on.
class LiftedLayer
{
public:
  /// \param sinking (4 D / k)^(1/4) of the base [m]; cells are half as long
  explicit LiftedLayer(const double sinking)
      : reach_(0.5 * length + 6. * sinking)
      , triangulation_(MPI_COMM_WORLD)
      , solid_(mesh(static_cast<unsigned int>(std::ceil(reach_ / (0.5 * sinking)))),
               {make_law<StVenantKirchhoff>(layer.young_modulus, layer.poisson_ratio)},
               NonlinearSolid::Options())
      , base_(std::make_shared<UnilateralFoundation>(
            solid_, BoundaryIds{boundary::bottom}, 4. * D / std::pow(sinking, 4)))
  {
    solid_.add(base_);
    Loads constant, growing;
    constant.dead = pressure(solid_, {boundary::right}, axial_force / layer.thickness);
    constant.dead->add(
        1., body_force(solid_,
                       [](const Point<2> &) {
                         return dealii::Tensor<1, 2>({0., -weight / layer.thickness});
                       }));
    prescribe(
        solid_, boundary::left, 0, [](const Point<2> &) { return 0.; },
        constant.displacements);
    hold_node(solid_, axis_of_crest(), 1, growing.displacements);
    for (auto &[dof, value] : growing.displacements)
      value = crest;
    body_ = std::make_unique<LoadedSolid>(solid_, constant, growing);
  }

  /// What must push at the crest to hold it at @p share of the theory's height, over the
  /// weight of the lifted half.
  double push(const double share)
  {
    NewtonSolver newton(*body_, NewtonSolver::Options());
    newton.advance(reached_, share, reached_ == 0. ? 2 : 1, u_);
    reached_ = share;
    return at_node(solid_, body_->reactions(), axis_of_crest(), 1) /
           (0.5 * weight * length);
  }

  /// Twice the distance from the crest at which the lower face first goes below the base,
  /// between two nodes [m]. Farther out it may rise again a little.
  double lifted_length() const
  {
    std::vector<std::pair<double, double>> face; // x and u_y of this rank's nodes
    for (const auto dof : solid_.locally_owned())
      if (const auto p = solid_.support_point(dof);
          solid_.component(dof) == 1 && std::abs(p[1] + 0.5 * layer.thickness) < 1e-9)
        face.emplace_back(p[0], u_(dof));
    std::map<double, double> all;
    for (const auto &part : dealii::Utilities::MPI::all_gather(MPI_COMM_WORLD, face))
      all.insert(part.begin(), part.end());
    auto low = all.begin();
    while (low->second > 0.)
      ++low;
    const auto up = std::prev(low);
    return 2. * (up->first +
                 (low->first - up->first) * up->second / (up->second - low->second));
  }

  double base_force() const { return base_->support(u_).force; }
  double reach() const { return reach_; }

private:
  static Point<2> axis_of_crest() { return {0., 0.}; }

  const Triangulation &mesh(const unsigned int n_columns)
  {
    make_rectangle(triangulation_, reach_, layer.thickness, n_columns, 1);
    return triangulation_;
  }

  double reach_;
  Triangulation triangulation_;
  NonlinearSolid solid_;
  std::shared_ptr<UnilateralFoundation> base_;
  std::unique_ptr<LoadedSolid> body_;
  Vector u_ = solid_.make_vector();
  double reached_ = 0.;
};

struct Found
{
  double height; ///< of the crest that needs no push, over the theory's
  double length; ///< over the theory's
};

Found find(const double sinking)
{
  LiftedLayer lifted(sinking);
  double a = 0.9, b = 1.02;
  double push_a = lifted.push(a), push_b = lifted.push(b);
  for (unsigned int i = 0; i < 2; ++i) // to 1e-6 of the height
  {
    const double c = b - push_b * (b - a) / (push_b - push_a);
    a = b;
    push_a = push_b;
    b = c;
    push_b = lifted.push(c);
  }
  EXPECT_NEAR(push_b, 0., 1e-5);
  // Newton's tolerance is 1e-8 of the axial force, some 100 times the weight.
  const double half = weight * lifted.reach();
  EXPECT_NEAR(lifted.base_force(), half, 1e-5 * half);
  return {b, lifted.lifted_length() / length};
}
} // namespace

TEST(Upheaval, LiftedLayerMeetsTheoryAsTheBaseGetsRigid)
{
  const Found soft = find(12.), middle = find(6.), stiff = find(3.);
  // What the theory leaves out: shear, P / (5/6 G h) = 0.1 %, and slopes of 1 %, squared.
  EXPECT_NEAR(stiff.height, 1., 0.003);
  EXPECT_NEAR(middle.height, 1., 0.01);
  EXPECT_LT(std::abs(middle.height - 1.), 0.3 * std::abs(soft.height - 1.));
  // A bending moment q l s / 2 where the layer comes down moves that place by s: first
  // order, in the crest's height second order or better.
  EXPECT_GT(std::log2((middle.height - soft.height) / (stiff.height - middle.height)),
            2.);
  EXPECT_NEAR(std::log2((middle.length - soft.length) / (stiff.length - middle.length)),
              1., 0.15);
  // P l^2 / D, extrapolated to a rigid base.
  const double l = 2. * stiff.length - middle.length;
  EXPECT_NEAR(constants.force * l * l, 80.763, 0.01 * 80.763);
}
} // namespace upheaval_tests
