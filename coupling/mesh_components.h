#pragma once

#include "continuum/elastic_solid.h"
#include "coupling/simulation.h"
#include "discrete/walls.h"

#include <vector>

namespace antiform::coupling
{
/// A mesh dof whose motion is given: by a wall (its velocity along x), or at rest.
struct PrescribedDof
{
  std::uint32_t dof = 0;   ///< local index
  int wall = -1;           ///< index into the walls; -1: held
  double layer_share = 0.; ///< of the reaction, that the competent layer takes
  double before = 0.;      ///< velocity before the kick [m/s]
  double reaction = 0.;    ///< force of the support on the mesh, of the last step [N]
  double mean = 0.;        ///< reaction where Walls averages over steps [N]
  double sum = 0.;         ///< of those since then [N]
};

/// The mesh as the loop moves it.
struct MeshState
{
  continuum::ElasticSolid &solid;
  continuum::Vector displacement, velocity, force;
  continuum::Vector mass;         ///< inertial, weighted and scaled [kg]
  continuum::Vector inverse_mass; ///< 0 where prescribed
  std::vector<PrescribedDof> prescribed;

  explicit MeshState(continuum::ElasticSolid &body);
  MPI_Comm communicator() const { return solid.dof_handler().get_communicator(); }
  /// Prescribe a dof; its inverse mass becomes zero.
  void prescribe(std::uint32_t dof, int wall, double layer_share = 0.);
  /// Inertial masses for quasi-static work: M* = max(M, dt0^2/4 sum_K |K_JK|).
  /// @p real_mass the weighted real mass; @p extra further row sums (foundation) or
  /// empty.
  void scale_density(const continuum::Vector &real_mass,
                     const std::vector<double> &extra,
                     double dt0);
};

/// Internal force, kick and drift of the mesh, and prescribed motion.
class MeshMotion : public Component
{
public:
  MeshMotion(MeshState &state, const std::vector<discrete::Wall> &walls)
      : state_(state)
      , walls_(walls)
  {
  }
  void run(Stage stage, const Clock &clock) override;
  void add_energies(Energies &energies) const override;
  void visit_state(StateArchive &archive) override;

  const std::vector<double> *damping = nullptr; ///< force to add at the kick

private:
  void kick(const Clock &clock);

  MeshState &state_;
  const std::vector<discrete::Wall> &walls_;
  std::vector<double> before_;
};

/// Winkler foundation under the mesh: rows of its boundary matrix.
class MeshFoundation : public Component
{
public:
  /// \param matrix boundary matrix of the springs, with the solid's sparsity
  MeshFoundation(MeshState &state, const dealii::TrilinosWrappers::SparseMatrix &matrix);
  void run(Stage stage, const Clock &clock) override;
  void add_energies(Energies &energies) const override;
  /// sum_K |K_JK| per dof, for mass scaling and the stable step [N/m].
  std::vector<double> absolute_row_sums() const;

private:
  struct Entry
  {
    std::uint32_t row, column;
    double value;
  };
  MeshState &state_;
  std::vector<Entry> entries_;
};

/// Nodal forces that do not change: weight of the mesh, surface pressure; or those of an
/// installed prestress, whose work is strain energy, not work of the boundary.
class MeshLoads : public Component
{
public:
  MeshLoads(MeshState &state, const continuum::Vector &load, bool is_prestress = false);
  void run(Stage stage, const Clock &clock) override;
  void add_energies(Energies &energies) const override;

private:
  MeshState &state_;
  std::vector<std::pair<std::uint32_t, double>> load_;
  bool is_prestress_;
};
} // namespace antiform::coupling
