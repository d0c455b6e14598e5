#include "coupling/distributed_system.h"

#include <Amesos.h>
#include <Amesos_BaseSolver.h>
#include <Epetra_CrsMatrix.h>
#include <Epetra_FECrsMatrix.h>
#include <Epetra_Import.h>
#include <Epetra_LinearProblem.h>
#include <Epetra_Map.h>
#include <Epetra_MpiComm.h>
#include <Epetra_Vector.h>
#include <Teuchos_ParameterList.hpp>

#include <algorithm>
#include <numeric>

namespace antiform::coupling
{
namespace
{
/// All rows on this rank, or none.
Epetra_Map whole_map(const int n, const bool here, const Epetra_Comm &comm)
{
  std::vector<int> rows(here ? n : 0);
  std::iota(rows.begin(), rows.end(), 0);
  return {-1, static_cast<int>(rows.size()), rows.data(), 0, comm};
}
} // namespace

struct DistributedSystem::Parts
{
  Parts(const int n, const std::vector<int> &own_rows, const MPI_Comm communicator)
      : comm(communicator)
      , map(n, static_cast<int>(own_rows.size()), own_rows.data(), 0, comm)
      , all(whole_map(n, true, comm))
      , from_owners(all, map)
      , matrix(Copy, map, 0)
      , right(map)
      , left(map)
      , whole(all)
      , problem(&matrix, &left, &right)
  {
  }

  Epetra_MpiComm comm;
  Epetra_Map map, all;
  Epetra_Import from_owners;
  Epetra_FECrsMatrix matrix;
  Epetra_Vector right, left, whole;
  Epetra_LinearProblem problem;
  std::unique_ptr<Amesos_BaseSolver> solver;
};

DistributedSystem::DistributedSystem(const Matrix &share,
                                     const std::vector<int> &own_rows,
                                     const MPI_Comm communicator)
    : parts_(std::make_unique<Parts>(
          static_cast<int>(share.rows()), own_rows, communicator))
{
  for (Eigen::Index row = 0; row < share.rows(); ++row)
  {
    const int begin = share.outerIndexPtr()[row], end = share.outerIndexPtr()[row + 1];
    if (end > begin)
      parts_->matrix.InsertGlobalValues(static_cast<int>(row), end - begin,
                                        share.valuePtr() + begin,
                                        share.innerIndexPtr() + begin);
  }
  parts_->matrix.GlobalAssemble();
}

DistributedSystem::~DistributedSystem() = default;

bool DistributedSystem::factorise()
{
  parts_->solver.reset(Amesos().Create("Amesos_Mumps", parts_->problem));
  Teuchos::ParameterList parameters;
  parameters.sublist("mumps").set("ICNTL(14)", 100); // [%] space for delayed pivots
  parts_->solver->SetParameters(parameters);
  return parts_->solver->SymbolicFactorization() == 0 &&
         parts_->solver->NumericFactorization() == 0;
}

bool DistributedSystem::solve(double *const b) const
{
  Parts &p = *parts_;
  const int n = p.whole.MyLength();
  std::copy(b, b + n, &p.whole[0]);
  p.right.PutScalar(0.);
  p.right.Export(p.whole, p.from_owners, Add);
  const bool succeeded = p.solver->Solve() == 0;
  p.whole.Import(p.left, p.from_owners, Insert);
  std::copy(&p.whole[0], &p.whole[0] + n, b);
  return succeeded;
}

double DistributedSystem::norm_one() const
{
  return parts_->matrix.NormOne();
}

Eigen::SparseMatrix<double> DistributedSystem::on_first_rank() const
{
  const int n = parts_->whole.MyLength();
  const Epetra_Map first = whole_map(n, parts_->comm.MyPID() == 0, parts_->comm);
  Epetra_CrsMatrix gathered(Copy, first, 0);
  gathered.Import(parts_->matrix, Epetra_Import(first, parts_->map), Insert);
  gathered.FillComplete(first, first);
  std::vector<Eigen::Triplet<double>> entries;
  for (int row = 0; row < gathered.NumMyRows(); ++row)
  {
    int n_entries = 0, *columns = nullptr;
    double *values = nullptr;
    gathered.ExtractMyRowView(row, n_entries, values, columns);
    for (int k = 0; k < n_entries; ++k)
      entries.emplace_back(row, gathered.GCID(columns[k]), values[k]);
  }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}
} // namespace antiform::coupling
