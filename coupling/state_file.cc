#include "coupling/state_file.h"

#include "coupling/output/whole_file.h"

#include <deal.II/base/mpi.h>

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <utility>

// A state file is a text block of 512 bytes (an HDF5 user block: `head -4 state.h5` shows
// it) with version, size and checksum, then an HDF5 image, built and parsed in memory. So
// a full disk is met by plain writes, and a damaged file is refused before HDF5 sees it.

namespace antiform::coupling
{
namespace
{
const std::string magic = "antiform state file\n";
const int format_version = 4;
const std::size_t block_size = 512;
const char *const contents_name = "contents";
const char *const ranks_name = "ranks"; // how many wrote the file

namespace ranks = dealii::Utilities::MPI;

/// Owner of an HDF5 identifier. A negative one is a failed call.
class Handle
{
public:
  Handle(const hid_t id, herr_t (*close)(hid_t), const std::string &what)
      : id_(id)
      , close_(close)
  {
    if (id < 0)
      throw std::runtime_error("HDF5 cannot handle " + what);
  }
  Handle(const Handle &) = delete;
  Handle &operator=(const Handle &) = delete;
  ~Handle() { close_(id_); }
  operator hid_t() const { return id_; }

private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void check(const long long result, const std::string &what)
{
  if (result < 0)
    throw std::runtime_error("HDF5 cannot handle " + what);
}

/// HDF5 prints its error stack by default; here every failure becomes an exception.
class QuietHdf5
{
public:
  QuietHdf5()
  {
    H5Eget_auto2(H5E_DEFAULT, &function_, &client_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  QuietHdf5(const QuietHdf5 &) = delete;
  QuietHdf5 &operator=(const QuietHdf5 &) = delete;
  ~QuietHdf5() { H5Eset_auto2(H5E_DEFAULT, function_, client_); }

private:
  H5E_auto2_t function_ = nullptr;
  void *client_ = nullptr;
};

hid_t file_type(const StateEntry &entry)
{
  const std::array<hid_t, 3> types{H5T_IEEE_F64LE, H5T_STD_I64LE, H5T_STD_U8LE};
  return types[entry.index()];
}

hid_t memory_type(const StateEntry &entry)
{
  const std::array<hid_t, 3> types{H5T_NATIVE_DOUBLE, H5T_NATIVE_INT64, H5T_NATIVE_UINT8};
  return types[entry.index()];
}

std::size_t size_of(const StateEntry &entry)
{
  return std::visit([](const auto &values) { return values.size(); }, entry);
}

void write_entry(const hid_t file, const std::string &name, const StateEntry &entry)
{
  const hsize_t n = size_of(entry);
  const Handle space(H5Screate_simple(1, &n, nullptr), H5Sclose, name);
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, name);
  check(H5Pset_create_intermediate_group(links, 1), name);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, name);
  check(H5Pset_obj_track_times(creation, false), name); // same state, same bytes
  const Handle set(H5Dcreate2(file, name.c_str(), file_type(entry), space, links,
                              creation, H5P_DEFAULT),
                   H5Dclose, "the name '" + name + "'");
  std::visit(
      [&](const auto &values)
      {
        if (!values.empty())
          check(H5Dwrite(set, memory_type(entry), H5S_ALL, H5S_ALL, H5P_DEFAULT,
                         values.data()),
                name);
      },
      entry);
}

void read_entry(const hid_t file, const std::string &name, StateEntry &entry)
{
  const Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, name);
  const Handle type(H5Dget_type(set), H5Tclose, name);
  if (H5Tequal(type, file_type(entry)) <= 0)
    throw std::runtime_error("entry '" + name + "' is not of its listed type");
  const Handle space(H5Dget_space(set), H5Sclose, name);
  const hssize_t n = H5Sget_simple_extent_npoints(space);
  check(n, name);
  std::visit(
      [&](auto &values)
      {
        values.resize(static_cast<std::size_t>(n));
        if (n > 0)
          check(H5Dread(set, memory_type(entry), H5S_ALL, H5S_ALL, H5P_DEFAULT,
                        values.data()),
                name);
      },
      entry);
}

StateEntry empty_entry(const std::size_t kind)
{
  switch (kind)
  {
  case 0:
    return std::vector<double>();
  case 1:
    return std::vector<std::int64_t>();
  case 2:
    return std::string();
  default:
    throw std::runtime_error("an entry has the unknown type " + std::to_string(kind));
  }
}

/// The HDF5 file of @p entries, as bytes. The data set "contents" lists type and name of
/// each, one a line.
std::string make_image(const std::map<std::string, StateEntry> &entries)
{
  std::string contents;
  std::size_t n_bytes = 1u << 16;
  for (const auto &[name, entry] : entries)
  {
    contents += std::to_string(entry.index()) + ' ' + name + '\n';
    n_bytes += 8 * size_of(entry) + 1024;
  }
  const std::string what = "the file in memory";
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, what);
  check(H5Pset_fapl_core(access, n_bytes, false), what);
  const Handle file(H5Fcreate("state", H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose,
                    what);
  write_entry(file, contents_name, contents);
  for (const auto &[name, entry] : entries)
    write_entry(file, name, entry);
  check(H5Fflush(file, H5F_SCOPE_GLOBAL), what);
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  check(size, what);
  std::string image(static_cast<std::size_t>(size), '\0');
  check(H5Fget_file_image(file, image.data(), image.size()), what);
  return image;
}

std::map<std::string, StateEntry> parse_image(std::string image)
{
  const std::string what = "the contents";
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, what);
  check(H5Pset_fapl_core(access, 1u << 16, false), what);
  check(H5Pset_file_image(access, image.data(), image.size()), what);
  image.clear();
  image.shrink_to_fit(); // HDF5 has its own copy now
  const Handle file(H5Fopen("state", H5F_ACC_RDONLY, access), H5Fclose, what);
  StateEntry contents = std::string();
  read_entry(file, contents_name, contents);

  std::map<std::string, StateEntry> entries;
  std::istringstream lines(std::get<std::string>(contents));
  std::size_t kind = 0;
  std::string name;
  while (lines >> kind && lines.get() == ' ' && std::getline(lines, name))
  {
    StateEntry entry = empty_entry(kind);
    read_entry(file, name, entry);
    entries.emplace(name, std::move(entry));
  }
  return entries;
}

std::string make_block(const int version, const std::size_t n_bytes, std::uint64_t crc)
{
  std::array<char, block_size> text{};
  std::snprintf(text.data(), text.size(), "%sversion %d\nbytes %zu\ncrc64 %016llx\n",
                magic.c_str(), version, n_bytes, static_cast<unsigned long long>(crc));
  return {text.data(), text.size()};
}

/// Version, size and checksum of a file; returns what is wrong with them and the remedy,
/// or nothing.
std::string problem_of(const std::string &bytes)
{
  if (bytes.compare(0, magic.size(), magic) != 0)
    return "it is not a state file of antiform (state.h5). Check the folder, or run "
           "afresh in another directory (-o DIR).";
  int version = 0;
  std::size_t n_bytes = 0;
  unsigned long long crc = 0;
  const std::string block = bytes.substr(0, block_size);
  const int found =
      std::sscanf(block.c_str() + magic.size(), "version %d bytes %zu crc64 %16llx",
                  &version, &n_bytes, &crc);
  if (found >= 1 && version != format_version)
    return "it is of format version " + std::to_string(version) +
           ", this program reads version " + std::to_string(format_version) +
           ". Resume with the program that wrote it, or run afresh in another directory "
           "(-o DIR).";
  const std::string damaged =
      " It was damaged after it was written: restore it from a copy, or run "
      "afresh in another directory (-o DIR).";
  if (found == 3 && bytes.size() != n_bytes)
    return "it has " + std::to_string(bytes.size()) + " bytes of the " +
           std::to_string(n_bytes) + " that were written." + damaged;
  if (found != 3 || bytes.size() < block_size ||
      block != make_block(version, n_bytes, crc))
    return "its first 512 bytes are not as they were written." + damaged;
  if (crc64(bytes.data() + block_size, bytes.size() - block_size) != crc)
    return "its checksum does not match its contents." + damaged;
  return "";
}

void check_name(const std::string &name)
{
  const std::string path = '/' + name + '/';
  if (name == contents_name || name == ranks_name ||
      path.find("//") != std::string::npos || path.find("/./") != std::string::npos ||
      name.find('\n') != std::string::npos)
    throw std::logic_error("A state entry cannot be called '" + name +
                           "': give it words separated by single slashes.");
}

/// Do @p work on the first rank; what it throws is thrown on every rank.
void on_first_rank(const MPI_Comm communicator, const std::function<void()> &work)
{
  std::string problem;
  if (ranks::this_mpi_process(communicator) == 0)
    try
    {
      work();
    }
    catch (const std::runtime_error &error)
    {
      problem = error.what();
    }
  problem = ranks::broadcast(communicator, problem);
  if (!problem.empty())
    throw std::runtime_error(problem);
}

void write_state(const std::string &path,
                 const std::map<std::string, StateEntry> &entries)
{
  const QuietHdf5 quiet;
  std::string image;
  try
  {
    image = make_image(entries);
  }
  catch (const std::runtime_error &error)
  {
    throw std::runtime_error("'" + path + "' cannot be composed: " + error.what() + ".");
  }
  const std::uint64_t crc = crc64(image.data(), image.size());
  image.insert(0, make_block(format_version, block_size + image.size(), crc));
  replace_file(path, image);
}

const char *type_name(const std::size_t kind)
{
  const std::array<const char *, 3> names{"numbers", "integers", "text"};
  return names[kind];
}
} // namespace

std::uint64_t crc64(const void *bytes, const std::size_t n)
{
  static const std::array<std::uint64_t, 256> table = []
  {
    std::array<std::uint64_t, 256> t{};
    for (std::uint64_t i = 0; i < 256; ++i)
    {
      t[i] = i;
      for (int bit = 0; bit < 8; ++bit)
        t[i] = (t[i] >> 1) ^ (t[i] & 1 ? 0xC96C5795D7870F42u : 0u);
    }
    return t;
  }();
  const auto *byte = static_cast<const unsigned char *>(bytes);
  std::uint64_t crc = ~std::uint64_t(0);
  for (std::size_t i = 0; i < n; ++i)
    crc = table[(crc ^ byte[i]) & 0xff] ^ (crc >> 8);
  return ~crc;
}

void StateArchive::value(const std::string &name, double &x)
{
  std::vector<double> values(1, x);
  array(name, values);
  x = values[0];
}

void StateArchive::owned_value(const std::string &name, double &x)
{
  std::vector<double> values(1, x);
  owned_array(name, values);
  x = values[0];
}

void StateArchive::value(const std::string &name, std::int64_t &x)
{
  std::vector<std::int64_t> values(1, x);
  array(name, values);
  x = values[0];
}

void StateWriter::add(const std::string &name, StateEntry entry)
{
  check_name(name);
  if (!entries_.emplace(name, std::move(entry)).second)
    throw std::logic_error("State entry '" + name +
                           "' is listed twice: each object needs "
                           "names of its own.");
}

void StateWriter::array(const std::string &name, std::vector<double> &values)
{
  add(name, values);
}

void StateWriter::array(const std::string &name, std::vector<std::int64_t> &values)
{
  add(name, values);
}

void StateWriter::text(const std::string &name, std::string &value)
{
  add(name, value);
}

void StateWriter::owned_array(const std::string &name, std::vector<double> &values)
{
  std::vector<double> all;
  for (const std::vector<double> &part : ranks::gather(communicator_, values))
    all.insert(all.end(), part.begin(), part.end());
  add(name, std::move(all)); // nothing, but on the first rank
}

void StateWriter::commit(const std::string &path) const
{
  on_first_rank(communicator_,
                [&]
                {
                  std::map<std::string, StateEntry> entries = entries_;
                  entries[ranks_name] = std::vector<std::int64_t>{
                      std::int64_t{ranks::n_mpi_processes(communicator_)}};
                  write_state(path, entries);
                });
}

StateReader::StateReader(const std::string &path, const MPI_Comm communicator)
    : path_(path)
    , communicator_(communicator)
{
  std::string bytes;
  on_first_rank(communicator,
                [&]
                {
                  bytes = read_file(path);
                  const std::string problem = problem_of(bytes);
                  if (!problem.empty())
                    throw std::runtime_error("'" + path +
                                             "' cannot be resumed from: " + problem);
                });
  bytes = ranks::broadcast(communicator, bytes);
  const QuietHdf5 quiet;
  try
  {
    bytes.erase(0, block_size);
    entries_ = parse_image(std::move(bytes));
  }
  catch (const std::runtime_error &error)
  {
    throw std::runtime_error("'" + path + "' cannot be resumed from: " + error.what() +
                             ". Resume with the program that wrote it, or run afresh in "
                             "another directory (-o DIR).");
  }
  const std::int64_t n_ranks = ranks::n_mpi_processes(communicator);
  const std::int64_t n_written = find<std::vector<std::int64_t>>(ranks_name).at(0);
  if (n_ranks != n_written)
    throw std::runtime_error("'" + path + "' was written by " +
                             std::to_string(n_written) + " MPI rank(s), this run has " +
                             std::to_string(n_ranks) + ". Resume with mpirun -np " +
                             std::to_string(n_written) +
                             ", or run afresh in another directory (-o DIR).");
  for (const auto &entry : entries_)
    is_read_[entry.first] = entry.first == ranks_name;
}

template <class T>
T &StateReader::find(const std::string &name)
{
  const auto place = entries_.find(name);
  if (place == entries_.end())
    throw std::runtime_error(
        "'" + path_ + "' has no entry '" + name +
        "': it belongs to another deck or another version of the "
        "program. Resume with those, or run afresh in another directory (-o DIR).");
  T *const contents = std::get_if<T>(&place->second);
  if (!contents)
    throw std::runtime_error(
        "'" + path_ + "' holds " + type_name(place->second.index()) + " as entry '" +
        name + "', " + type_name(StateEntry(T()).index()) +
        " are wanted: it was written by another version of the "
        "program. Resume with that one, or run afresh in another directory (-o DIR).");
  is_read_[name] = true;
  return *contents;
}

template <class T>
void StateReader::load(const std::string &name, std::vector<T> &values)
{
  const std::vector<T> &stored = find<std::vector<T>>(name);
  if (!values.empty())
    check_size(name, stored.size(), values.size());
  values = stored;
}

void StateReader::check_size(const std::string &name,
                             const std::size_t stored,
                             const std::size_t wanted) const
{
  if (stored != wanted)
    throw std::runtime_error("'" + path_ + "' has " + std::to_string(stored) +
                             " values in entry '" + name +
                             "', the scene of this deck needs " + std::to_string(wanted) +
                             ". Resume with the deck that wrote it, or run afresh in "
                             "another directory (-o DIR).");
}

void StateReader::array(const std::string &name, std::vector<double> &values)
{
  load(name, values);
}

void StateReader::array(const std::string &name, std::vector<std::int64_t> &values)
{
  load(name, values);
}

void StateReader::owned_array(const std::string &name, std::vector<double> &values)
{
  const std::vector<double> &stored = find<std::vector<double>>(name);
  std::size_t begin = 0, total = 0, rank = 0;
  for (const std::size_t n : ranks::all_gather(communicator_, values.size()))
  {
    begin += rank < ranks::this_mpi_process(communicator_) ? n : 0;
    total += n;
    ++rank;
  }
  check_size(name, stored.size(), total);
  std::copy_n(stored.begin() + static_cast<std::ptrdiff_t>(begin), values.size(),
              values.begin());
}

void StateReader::text(const std::string &name, std::string &value)
{
  value = find<std::string>(name);
}

void StateReader::expect_all_read() const
{
  for (const auto &[name, is_read] : is_read_)
    if (!is_read)
      throw std::runtime_error(
          "'" + path_ + "' holds the entry '" + name +
          "', which nothing in this deck uses. Resume with the deck "
          "that wrote it, or run afresh in another directory (-o DIR).");
}
} // namespace antiform::coupling
