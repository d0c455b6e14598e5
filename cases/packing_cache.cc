#include "cases/packing_cache.h"

#include "coupling/state_file.h"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <unistd.h>

namespace antiform::cases
{
namespace
{
constexpr char magic[] = "antiform packing 1\n"; // the format of the file

std::string hexadecimal(const std::uint64_t number)
{
  char text[20];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(number));
  return text;
}

/// Length of the key, key, numbers.
std::string pack(const std::string &key, const std::vector<double> &numbers)
{
  std::string body = hexadecimal(key.size()) + key;
  body.append(reinterpret_cast<const char *>(numbers.data()),
              numbers.size() * sizeof(double));
  return body;
}
} // namespace

PackingCache::PackingCache(std::string directory)
    : directory_(std::move(directory))
{
}

std::string PackingCache::default_directory()
{
  const auto variable = [](const char *name)
  {
    const char *const value = std::getenv(name);
    return std::string(value != nullptr ? value : "");
  };
  if (const std::string own = variable("ANTIFORM_CACHE"); !own.empty())
    return own == "off" ? "" : own;
  // A relative path is to be ignored, says the XDG base directory specification.
  if (const std::string xdg = variable("XDG_CACHE_HOME"); !xdg.empty() && xdg[0] == '/')
    return xdg + "/antiform";
  const std::string home = variable("HOME");
  return home.empty() ? "" : home + "/.cache/antiform";
}

std::string PackingCache::file(const std::string &key) const
{
  return directory_.empty()
             ? ""
             : directory_ + "/" + hexadecimal(coupling::crc64(key.data(), key.size())) +
                   ".packing";
}

std::optional<std::vector<double>> PackingCache::find(const std::string &key,
                                                      std::string &complaint) const
{
  complaint.clear();
  const std::string path = file(key);
  std::ifstream stream(path, std::ios::binary);
  if (path.empty() || !stream)
    return {};
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  // Magic, checksum of the rest, the rest.
  const std::size_t head = std::strlen(magic) + 16;
  const std::string_view body =
      text.size() > head ? std::string_view(text).substr(head) : std::string_view();
  if (text.compare(0, std::strlen(magic), magic) != 0 || body.size() < 16 ||
      text.compare(std::strlen(magic), 16,
                   hexadecimal(coupling::crc64(body.data(), body.size()))) != 0)
  {
    complaint = "the packing kept in '" + path + "' is damaged; it is made anew";
    return {};
  }
  const std::size_t begin = 16 + key.size();
  if (body.substr(0, 16) != hexadecimal(key.size()) ||
      body.compare(16, key.size(), key) != 0)
    return {}; // another packing with the same hash
  std::vector<double> numbers((body.size() - begin) / sizeof(double));
  std::memcpy(numbers.data(), body.data() + begin, numbers.size() * sizeof(double));
  return numbers;
}

bool PackingCache::store(const std::string &key, const std::vector<double> &numbers) const
{
  const std::string path = file(key);
  if (path.empty())
    return false;
  std::error_code error;
  std::filesystem::create_directories(directory_, error);
  // A name of its own for each process: two runs may make the same packing.
  const std::string temporary = path + "." + std::to_string(getpid()) + ".tmp";
  const std::string body = pack(key, numbers);
  std::ofstream stream(temporary, std::ios::binary);
  stream << magic << hexadecimal(coupling::crc64(body.data(), body.size())) << body;
  stream.close();
  if (stream)
    std::filesystem::rename(temporary, path, error);
  if (stream && !error)
    return true;
  std::filesystem::remove(temporary, error);
  return false;
}
} // namespace antiform::cases
