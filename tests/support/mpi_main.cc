#include <gtest/gtest.h>

#include <deal.II/base/mpi.h>

// One MPI for all tests, one printer; a failure on any rank fails on every rank.
int main(int argc, char **argv)
{
  ::testing::InitGoogleTest(&argc, argv);
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  auto &listeners = ::testing::UnitTest::GetInstance()->listeners();
  if (dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
    delete listeners.Release(listeners.default_result_printer());
  const int local = RUN_ALL_TESTS();
  return dealii::Utilities::MPI::max(local, MPI_COMM_WORLD);
}
