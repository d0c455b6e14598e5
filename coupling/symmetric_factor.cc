#include "coupling/symmetric_factor.h"

#include "continuum/errors.h"

#include <dmumps_c.h>
#include <mpi.h>

#include <vector>

namespace antiform::coupling
{
struct SymmetricFactor::Mumps
{
  DMUMPS_STRUC_C call{};
  std::vector<MUMPS_INT> row, column;
  std::vector<double> value;
  int n_negative = 0, n_null = 0;

  Mumps()
  {
    call.comm_fortran = MPI_Comm_c2f(MPI_COMM_SELF);
    call.par = 1;
    call.sym = 2; // general symmetric
    run(-1);
    for (const int quiet : {1, 2, 3})
      icntl(quiet) = -1;
    icntl(4) = 0;
    icntl(13) = 1;  // the last front as the others: its pivots' signs are counted
    icntl(14) = 50; // [%] space for delayed pivots
    icntl(24) = 1;  // pivots of round-off are counted
  }
  ~Mumps() { run(-2); }
  Mumps(const Mumps &) = delete;

  MUMPS_INT &icntl(const int number) { return call.icntl[number - 1]; }
  int infog(const int number) const { return call.infog[number - 1]; }
  int run(const MUMPS_INT job)
  {
    call.job = job;
    dmumps_c(&call);
    return infog(1);
  }
};

SymmetricFactor::SymmetricFactor(
    const Eigen::SparseMatrix<double, Eigen::RowMajor> &matrix)
    : mumps_(std::make_unique<Mumps>())
{
  using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  Mumps &m = *mumps_;
  for (Eigen::Index r = 0; r < matrix.rows(); ++r)
    for (Rows::InnerIterator it(matrix, r); it && it.col() <= r; ++it)
    {
      m.row.push_back(static_cast<MUMPS_INT>(r + 1));
      m.column.push_back(static_cast<MUMPS_INT>(it.col() + 1));
      m.value.push_back(it.value());
    }
  m.call.n = static_cast<MUMPS_INT>(matrix.rows());
  m.call.nnz = static_cast<MUMPS_INT8>(m.value.size());
  m.call.irn = m.row.data();
  m.call.jcn = m.column.data();
  m.call.a = m.value.data();
  int result = m.run(4); // analysis and factors
  for (int more = 0; more < 4 && (result == -8 || result == -9); ++more)
  {
    m.icntl(14) *= 2; // more pivots were delayed than there was space for
    result = m.run(2);
  }
  if (result < 0)
    throw NumericalError("symmetric factor",
                         "MUMPS cannot factor the system matrix: a part of the section "
                         "has no path to a support. Its INFOG(1)",
                         result, 0.);
  m.n_negative = m.infog(12);
  m.n_null = m.infog(28);
}

SymmetricFactor::~SymmetricFactor() = default;
SymmetricFactor::SymmetricFactor(SymmetricFactor &&) noexcept = default;

Eigen::VectorXd SymmetricFactor::solve(const Eigen::VectorXd &right) const
{
  Eigen::VectorXd x = right;
  mumps_->call.rhs = x.data();
  mumps_->call.nrhs = 1;
  mumps_->call.lrhs = mumps_->call.n;
  const int result = mumps_->run(3);
  if (result < 0)
    throw NumericalError("symmetric factor", "MUMPS cannot solve. Its INFOG(1)", result,
                         0.);
  return x;
}

int SymmetricFactor::n_negative() const
{
  return mumps_->n_negative;
}
int SymmetricFactor::n_null() const
{
  return mumps_->n_null;
}
} // namespace antiform::coupling
