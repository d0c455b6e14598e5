#include "cases/packing_cache.h"

#include "support/files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace packing_cache_tests
{
using namespace antiform::cases;
using antiform::test::TemporaryFolder;

namespace
{
/// An environment variable for the time of a scope; null: not set.
class Variable
{
public:
  Variable(const char *name, const char *value)
      : name_(name)
  {
    if (const char *const before = std::getenv(name))
      before_ = before;
    set(value);
  }
  ~Variable() { set(before_ ? before_->c_str() : nullptr); }
  Variable(const Variable &) = delete;
  Variable &operator=(const Variable &) = delete;

private:
  void set(const char *value)
  {
    if (value != nullptr)
      setenv(name_, value, 1);
    else
      unsetenv(name_);
  }
  const char *name_;
  std::optional<std::string> before_;
};

const std::vector<double> numbers{1. / 3., -0., 1e-300, 42.};

std::optional<std::vector<double>> find(const PackingCache &cache, const std::string &key)
{
  std::string complaint;
  auto found = cache.find(key, complaint);
  EXPECT_EQ(complaint, "");
  return found;
}
} // namespace

TEST(PackingCache, GivesBackWhatWasStored)
{
  const TemporaryFolder folder;
  const PackingCache cache(folder.path("new/cache"));
  EXPECT_FALSE(find(cache, "key"));
  EXPECT_TRUE(cache.store("key", numbers));
  const auto found = find(cache, "key");
  ASSERT_TRUE(found);
  EXPECT_EQ(*found, numbers);
  EXPECT_TRUE(std::signbit((*found)[1])); // the same bits
  EXPECT_FALSE(find(cache, "another key"));
  std::size_t files = 0;
  for (const auto &file : std::filesystem::directory_iterator(folder.path("new/cache")))
  {
    ++files;
    EXPECT_EQ(file.path().extension(), ".packing"); // nothing temporary stays
  }
  EXPECT_EQ(files, 1u);
}

TEST(PackingCache, AnotherKeyWithTheSameHashIsNotFound)
{
  const TemporaryFolder folder;
  const PackingCache cache(folder.path("cache"));
  ASSERT_TRUE(cache.store("key", numbers));
  std::filesystem::rename(cache.file("key"), cache.file("another"));
  EXPECT_FALSE(find(cache, "another"));
}

TEST(PackingCache, NoticesEveryDamagedByteAndEveryTruncation)
{
  const TemporaryFolder folder;
  const PackingCache cache(folder.path("cache"));
  ASSERT_TRUE(cache.store("key", numbers));
  std::ifstream stream(cache.file("key"), std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(stream), {}};
  const auto expect_complaint = [&](const std::string &text)
  {
    std::ofstream(cache.file("key"), std::ios::binary) << text;
    std::string complaint;
    EXPECT_FALSE(cache.find("key", complaint));
    EXPECT_NE(complaint.find("damaged"), std::string::npos) << complaint;
  };
  for (std::size_t at = 0; at < whole.size(); ++at)
  {
    std::string damaged = whole;
    damaged[at] ^= 4;
    expect_complaint(damaged);
    expect_complaint(whole.substr(0, at));
  }
  ASSERT_TRUE(cache.store("key", numbers)); // replaces it
  EXPECT_TRUE(find(cache, "key"));
}

TEST(PackingCache, IsNoErrorWhereNothingCanBeWritten)
{
  EXPECT_FALSE(PackingCache("").store("key", numbers));
  EXPECT_FALSE(find(PackingCache(""), "key"));
  const TemporaryFolder folder;
  std::ofstream(folder.path("file")) << "not a folder";
  const PackingCache cache(folder.path("file"));
  EXPECT_FALSE(cache.store("key", numbers));
  EXPECT_FALSE(find(cache, "key"));
  // A full disk leaves nothing behind.
  const PackingCache full(folder.path("full"));
  {
    const antiform::test::FullDisk disk(16);
    EXPECT_FALSE(full.store("key", numbers));
  }
  EXPECT_FALSE(find(full, "key"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path("full")));
}

TEST(PackingCache, LivesWhereTheEnvironmentSays)
{
  const Variable own("ANTIFORM_CACHE", nullptr), xdg("XDG_CACHE_HOME", nullptr),
      home("HOME", "/home/someone");
  EXPECT_EQ(PackingCache::default_directory(), "/home/someone/.cache/antiform");
  {
    const Variable set("XDG_CACHE_HOME", "/big/cache");
    EXPECT_EQ(PackingCache::default_directory(), "/big/cache/antiform");
    const Variable mine("ANTIFORM_CACHE", "/mine");
    EXPECT_EQ(PackingCache::default_directory(), "/mine");
    const Variable off("ANTIFORM_CACHE", "off");
    EXPECT_EQ(PackingCache::default_directory(), "");
  }
  const Variable relative("XDG_CACHE_HOME", "relative");
  EXPECT_EQ(PackingCache::default_directory(), "/home/someone/.cache/antiform");
  const Variable homeless("HOME", nullptr);
  EXPECT_EQ(PackingCache::default_directory(), "");
}
} // namespace packing_cache_tests
