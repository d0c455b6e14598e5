#pragma once

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
/// ("grains/rotation").
///
/// Loading fills an empty array with whatever the file holds (lists that grow); an array
/// that has a size already must find exactly that size. A missing name, a name of another
/// type, or another size is a std::runtime_error.
class StateArchive
{
public:
  virtual ~StateArchive() = default;
  virtual bool is_loading() const = 0;
  virtual void array(const std::string &name, std::vector<double> &values) = 0;
  virtual void array(const std::string &name, std::vector<std::int64_t> &values) = 0;
  virtual void text(const std::string &name, std::string &value) = 0;
  void value(const std::string &name, double &x);
  void value(const std::string &name, std::int64_t &x);
};

/// Contents of an entry; the alternatives' order is the code of their type in the file.
using StateEntry =
    std::variant<std::vector<double>, std::vector<std::int64_t>, std::string>;

/// Collects arrays and writes them to an HDF5 file under a temporary name, with a
/// checksum over all contents, flushed to disk and renamed into place by commit(). A kill
/// or a full disk at any moment leaves the former file as it was. Throws
/// std::runtime_error with the file and the reason when the disk is full or the folder
/// cannot be written, and std::logic_error for a name that is listed twice or cannot be
/// one.
class StateWriter : public StateArchive
{
public:
  bool is_loading() const override { return false; }
  void array(const std::string &name, std::vector<double> &values) override;
  void array(const std::string &name, std::vector<std::int64_t> &values) override;
  void text(const std::string &name, std::string &value) override;
  void commit(const std::string &path) const;

private:
  void add(const std::string &name, StateEntry entry);

  std::map<std::string, StateEntry> entries_;
};

/// Loads a file of StateWriter. Throws std::runtime_error naming the file and what is
/// wrong (missing, truncated, checksum, foreign version) before anything is handed out.
class StateReader : public StateArchive
{
public:
  explicit StateReader(const std::string &path);
  bool is_loading() const override { return true; }
  void array(const std::string &name, std::vector<double> &values) override;
  void array(const std::string &name, std::vector<std::int64_t> &values) override;
  void text(const std::string &name, std::string &value) override;

  /// Throw if the file holds an entry that nobody has asked for: state that this program
  /// would forget. Call after the last object has loaded.
  void expect_all_read() const;

private:
  template <class T>
  T &find(const std::string &name);
  template <class T>
  void load(const std::string &name, std::vector<T> &values);

  std::string path_;
  std::map<std::string, StateEntry> entries_;
  std::map<std::string, bool> is_read_;
};

/// CRC-64/XZ (ECMA-182 polynomial, reflected) of @p n bytes: the checksum of state files.
std::uint64_t crc64(const void *bytes, std::size_t n);
} // namespace antiform::coupling
