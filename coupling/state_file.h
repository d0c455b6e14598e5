#pragma once

#include "coupling/state_image.h"

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace antiform::coupling
{
/// Everything that must survive a restart passes through here, both ways: an object lists
/// its arrays once, in visit_state(StateArchive &), and the archive either stores or
/// loads them. Names are unique within a file and may group by slashes
/// ("grains/rotation"). On several ranks array() and text() hold what all ranks have
/// alike; owned_array() holds a part on each rank, the file has them all, by rank.
///
/// Loading fills an empty array with whatever the file holds (lists that grow); an array
/// that has a size already must find exactly that size. A missing name, a name of another
/// type, or another size is a std::runtime_error. An owned array has its size already.
class StateArchive
{
public:
  virtual ~StateArchive() = default;
  virtual bool is_loading() const = 0;
  virtual void array(const std::string &name, std::vector<double> &values) = 0;
  virtual void array(const std::string &name, std::vector<std::int64_t> &values) = 0;
  virtual void text(const std::string &name, std::string &value) = 0;
  /// Collective.
  virtual void owned_array(const std::string &name, std::vector<double> &values) = 0;
  void owned_value(const std::string &name, double &x);
  void value(const std::string &name, double &x);
  void value(const std::string &name, std::int64_t &x);
};

/// Collects arrays and writes them to an HDF5 file under a temporary name, with a
/// checksum over all contents, flushed to disk and renamed into place by commit(). A kill
/// or a full disk at any moment leaves the former file as it was. Throws
/// std::runtime_error with the file and the reason when the disk is full or the folder
/// cannot be written, and std::logic_error for a name that is listed twice or cannot be
/// one.
class StateWriter : public StateArchive
{
public:
  explicit StateWriter(MPI_Comm communicator = MPI_COMM_SELF)
      : communicator_(communicator)
  {
  }
  bool is_loading() const override { return false; }
  void array(const std::string &name, std::vector<double> &values) override;
  void array(const std::string &name, std::vector<std::int64_t> &values) override;
  void text(const std::string &name, std::string &value) override;
  void owned_array(const std::string &name, std::vector<double> &values) override;
  /// Collective; the first rank writes, and a failure there is thrown on all.
  void commit(const std::string &path) const;

private:
  MPI_Comm communicator_;
  void add(const std::string &name, StateEntry entry);

  std::map<std::string, StateEntry> entries_;
};

/// Loads a file of StateWriter, read by the first rank. Throws std::runtime_error naming
/// the file and what is wrong (missing, truncated, checksum, foreign version, another
/// number of ranks) before anything is handed out, on all ranks alike.
class StateReader : public StateArchive
{
public:
  explicit StateReader(const std::string &path, MPI_Comm communicator = MPI_COMM_SELF);
  bool is_loading() const override { return true; }
  void array(const std::string &name, std::vector<double> &values) override;
  void array(const std::string &name, std::vector<std::int64_t> &values) override;
  void text(const std::string &name, std::string &value) override;
  void owned_array(const std::string &name, std::vector<double> &values) override;

  /// Throw if the file holds an entry that nobody has asked for: state that this program
  /// would forget. Call after the last object has loaded.
  void expect_all_read() const;

private:
  template <class T>
  T &find(const std::string &name);
  template <class T>
  void load(const std::string &name, std::vector<T> &values);
  void check_size(const std::string &name, std::size_t stored, std::size_t wanted) const;

  std::string path_;
  MPI_Comm communicator_;
  std::map<std::string, StateEntry> entries_;
  std::map<std::string, bool> is_read_;
};
} // namespace antiform::coupling
