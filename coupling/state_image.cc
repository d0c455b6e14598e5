#include "coupling/state_image.h"

#include <hdf5.h>

#include <array>
#include <cstdio>
#include <cstring>
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
  write_entry(file, state_contents_name, contents);
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
  read_entry(file, state_contents_name, contents);

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
} // namespace

std::string state_bytes(const std::map<std::string, StateEntry> &entries)
{
  const QuietHdf5 quiet;
  std::string image = make_image(entries);
  const std::uint64_t crc = crc64(image.data(), image.size());
  image.insert(0, make_block(format_version, block_size + image.size(), crc));
  return image;
}

std::string problem_of_state(const std::string &bytes)
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

std::map<std::string, StateEntry> parse_state(std::string bytes)
{
  const QuietHdf5 quiet;
  bytes.erase(0, block_size);
  return parse_image(std::move(bytes));
}

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
} // namespace antiform::coupling
