#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace antiform::cases
{
/// Even cells in rows, as large as the mesh of a scene.
struct MeshShape
{
  double columns = 0., rows = 0.;
  int degree = 1;

  double cells() const { return columns * rows; }
  double dofs() const
  {
    return 2. * (degree * columns + 1.) * (degree * rows + 1.);
  }
};

/// Of one degree of freedom of an elastic body at rest [s].
struct SolvePace
{
  double assembly = 0., factor = 0., solution = 0.;
};

/// How fast a core of this machine is now at the work that scenes are made of: the
/// program's own kernels, run for a moment on grains and meshes about as large as the
/// scene's, in seconds of the processor. Each is measured when it is first asked for, so
/// that a scene waits for its own alone: a tenth of a second each. No run reads these
/// figures.
class MachineSpeed
{
public:
  MachineSpeed();

  /// Of one grain in one step: forces of its three intact joints with their strengths
  /// looked at, damping, kick and drift [s].
  double grain_step(double n_grains);
  /// Of one dof in one step in time: the internal force [s].
  double dof_step(const MeshShape &mesh);
  /// Of a direct factor, or of conjugate gradients with their preconditioner.
  const SolvePace &direct_solve(const MeshShape &mesh);
  const SolvePace &iterative_solve(const MeshShape &mesh);

  /// What the program has taken before this was made: reading libraries and deck [s].
  double start_seconds() const { return start_seconds_; }
  /// Of the program without a scene [bytes].
  double program_memory() const { return program_memory_; }

  struct Measured
  {
    std::string what;
    double size;        ///< of the sample, in units
    double nanoseconds; ///< of the processor, for one unit
    std::string unit;   ///< "a grain"
  };
  const std::vector<Measured> &measured() const { return measured_; }

private:
  const SolvePace &
  solve(const MeshShape &mesh, bool direct, std::map<std::string, SolvePace> &known);

  double start_seconds_, program_memory_;
  std::map<int, double> grain_steps_; ///< by the power of two of their number
  /// By the degree and the power of two of the dofs; their proportions hardly matter.
  std::map<std::pair<int, int>, double> dof_steps_;
  std::map<std::string, SolvePace> direct_, iterative_;
  std::vector<Measured> measured_;
};
} // namespace antiform::cases
