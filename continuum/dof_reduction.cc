#include "continuum/dof_reduction.h"

#include "continuum/direct_solver.h"
#include "continuum/hanging_nodes.h"

#include <deal.II/base/mpi.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <algorithm>
#include <map>
#include <stdexcept>

namespace antiform::continuum
{
using namespace dealii;
using GlobalDof = types::global_dof_index;

namespace
{
constexpr GlobalDof none = numbers::invalid_dof_index;

/// What every rank tells of the masters that it owns.
struct Master
{
  GlobalDof dof;
  GlobalDof unknown; ///< its number, or none where it is prescribed
  double value;      ///< prescribed [m]

  template <class Archive>
  void serialize(Archive &archive, unsigned int)
  {
    archive &dof &unknown &value;
  }
};

template <class T>
std::vector<T> gathered(const std::vector<T> &own, const MPI_Comm communicator)
{
  std::vector<T> all;
  for (const std::vector<T> &part : Utilities::MPI::all_gather(communicator, own))
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

/// Whether @p wrong is true on some rank.
void refuse_if(const bool wrong, const MPI_Comm communicator, const char *text)
{
  if (Utilities::MPI::max(wrong ? 1 : 0, communicator) != 0)
    throw std::invalid_argument(std::string("reduction of dofs: ") + text);
}
} // namespace

DofReduction::DofReduction(const DisplacementSpace &space,
                           const DirichletValues &values,
                           const std::vector<Tie> &ties)
    : space_(space)
    , prescribed_(space.make_vector())
{
  const MPI_Comm communicator = space.dof_handler().get_communicator();
  const IndexSet &dofs = space.locally_owned();
  const HangingNodes *const hanging = space.hanging_nodes();
  const auto hangs = [hanging](const GlobalDof dof)
  { return hanging != nullptr && hanging->contains(dof); };
  std::map<GlobalDof, const Tie *> tied;
  bool wrong = false;
  for (const auto &[dof, value] : values)
    wrong |= hangs(dof);
  for (const Tie &tie : ties)
    wrong |= hangs(tie.dof);
  refuse_if(wrong, communicator,
            "a dof that is prescribed or tied hangs on the edge of a larger cell.");
  for (const Tie &tie : ties)
  {
    wrong |= !dofs.is_element(tie.dof) || values.count(tie.dof) != 0 ||
             !tied.emplace(tie.dof, &tie).second;
  }
  refuse_if(wrong, communicator,
            "a tied dof is prescribed, tied twice, or of another rank.");

  // Numbers of the free dofs, rank after rank.
  std::map<GlobalDof, GlobalDof> unknown;
  GlobalDof n_own = 0;
  for (const GlobalDof dof : dofs)
    if (values.count(dof) == 0 && tied.count(dof) == 0 && !hangs(dof))
      unknown[dof] = n_own++;
  const auto counts = Utilities::MPI::all_gather(communicator, n_own);
  GlobalDof first = 0, n_all = 0;
  for (unsigned int rank = 0; rank < counts.size(); ++rank)
  {
    if (rank < Utilities::MPI::this_mpi_process(communicator))
      first += counts[rank];
    n_all += counts[rank];
  }
  owned_ = IndexSet(n_all);
  owned_.add_range(first, first + n_own);

  // Masters may be other ranks': each tells of its own.
  std::vector<GlobalDof> asked;
  for (const Tie &tie : ties)
    for (const auto &[master, factor] : tie.masters)
      asked.push_back(master);
  std::vector<Master> told;
  wrong = false;
  std::vector<GlobalDof> wanted = gathered(asked, communicator);
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  for (const GlobalDof dof : wanted)
    if (dofs.is_element(dof))
    {
      wrong |= tied.count(dof) != 0 || hangs(dof);
      const auto value = values.find(dof);
      told.push_back({dof, value == values.end() ? first + unknown[dof] : none,
                      value == values.end() ? 0. : value->second});
    }
  refuse_if(wrong, communicator, "a master of a tie is tied itself or hangs.");
  std::map<GlobalDof, Master> masters;
  for (const Master &master : gathered(told, communicator))
    masters.emplace(master.dof, master);

  struct Entry
  {
    GlobalDof row, column;
    double value;
  };
  std::vector<Entry> entries;
  for (const GlobalDof dof : dofs)
  {
    if (const auto tie = tied.find(dof); tie != tied.end())
    {
      for (const auto &[master, factor] : tie->second->masters)
      {
        const Master &of = masters.at(master);
        if (of.unknown != none)
          entries.push_back({dof, of.unknown, factor});
        else
          prescribed_(dof) += factor * of.value;
      }
    }
    else if (const auto value = values.find(dof); value != values.end())
      prescribed_(dof) = value->second;
    else if (!hangs(dof))
      entries.push_back({dof, first + unknown[dof], 1.});
  }
  TrilinosWrappers::SparsityPattern pattern(dofs, owned_, communicator);
  for (const Entry &entry : entries)
    pattern.add(entry.row, entry.column);
  pattern.compress();
  map_.reinit(pattern);
  for (const Entry &entry : entries)
    map_.add(entry.row, entry.column, entry.value);
  map_.compress(VectorOperation::add);
  if (hanging != nullptr)
  {
    const TrilinosWrappers::SparseMatrix of_edges(std::move(map_));
    hanging->map().mmult(map_, of_edges);
  }
  space.make_continuous(prescribed_);
}

TrilinosWrappers::SparseMatrix
DofReduction::reduce(const TrilinosWrappers::SparseMatrix &matrix) const
{
  TrilinosWrappers::SparseMatrix half, whole;
  matrix.mmult(half, map_);
  map_.Tmmult(whole, half);
  return whole;
}

Vector DofReduction::reduce(const Vector &force) const
{
  Vector reduced = make_vector(), owned = force;
  owned.zero_out_ghost_values();
  map_.Tvmult(reduced, owned);
  return reduced;
}

Vector DofReduction::expand(const Vector &unknowns, const bool homogeneous) const
{
  Vector displacement = space_.make_vector();
  map_.vmult(displacement, unknowns);
  if (!homogeneous)
    for (unsigned int i = 0; i < displacement.locally_owned_size(); ++i)
      displacement.local_element(i) += prescribed_.local_element(i);
  displacement.update_ghost_values();
  return displacement;
}

Vector solve_reduced(const ElasticSolid &solid,
                     const DofReduction &reduction,
                     const Vector &force)
{
  Vector full = solid.make_vector();
  solid.stiffness().vmult(full, reduction.prescribed());
  full.sadd(-1., 1., force);
  const Vector rhs = reduction.reduce(full);
  const TrilinosWrappers::SparseMatrix matrix = reduction.reduce(solid.stiffness());

  Vector unknowns = reduction.make_vector();
  DirectSolver(matrix).solve(rhs, unknowns);
  Vector rest = reduction.make_vector();
  matrix.vmult(rest, unknowns);
  rest -= rhs;
  constexpr double round_off = 1e-8; // of slender strips, as in StaticSolver
  const double scale = rhs.l2_norm() + matrix.linfty_norm() * unknowns.l2_norm();
  if (!(rest.l2_norm() <= round_off * scale))
    DirectSolver::refuse_singular(rest.l2_norm() / scale, round_off);
  return reduction.expand(unknowns);
}
} // namespace antiform::continuum
