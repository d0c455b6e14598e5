#include "cases/run_deck.h"

#include "cases/beds.h"
#include "coupling/output/whole_file.h"
#include "coupling/state_image.h"

#include <filesystem>
#include <fstream>
#include <iterator>

namespace antiform::cases
{
namespace
{
const std::string mark = "# Written by 'antiform run'";

std::string bytes_of(const std::string &path)
{
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}
} // namespace

RunDeck::RunDeck(const Parameters &p)
{
  Parameters beside = p;
  std::string checks;
  if (p.has("beds"))
    for (int k = 0; k < p.n_beds(); ++k)
    {
      const std::string number = std::to_string(k + 1), name = "rock-" + number + ".prm",
                        rock = rock_text(p.bed(k));
      beside.beds.rocks[static_cast<std::size_t>(k)] = name;
      files[name] = mark + ": the rock of bed " + number + " from below.\n" + rock;
      checks += "subsection Bed " + number + "\n" + rock + "end\n";
    }
  if (p.has("fractures") && !p.fractures.table.empty())
  {
    const std::string table = bytes_of(p.fractures.table);
    beside.fractures.table = "fractures.csv";
    files[beside.fractures.table] = table;
    checks += "set Checksum of Fractures/Table = " +
              std::to_string(coupling::crc64(table.data(), table.size())) + "\n";
  }
  text = effective_deck(beside);
  everything = text + checks;
}

void RunDeck::write(const std::string &directory) const
{
  for (const auto &[name, bytes] : files)
  {
    const std::string path = directory + "/" + name;
    std::error_code error;
    if (!std::filesystem::exists(path, error))
      continue;
    const std::string there = bytes_of(path);
    if (!std::filesystem::is_regular_file(path, error) ||
        (there != bytes && there.compare(0, mark.size(), mark) != 0))
      throw InputError(
          {"output directory '" + directory + "': '" + name +
           "' is no file of a run, and the run writes one of that name. Move "
           "it away, or give another directory with -o DIR."});
  }
  try
  {
    for (const auto &[name, bytes] : files)
      coupling::replace_file(directory + "/" + name, bytes);
    coupling::replace_file(directory + "/deck.prm", text);
  }
  catch (const std::runtime_error &error)
  {
    throw InputError({"output directory '" + directory +
                      "' cannot be written to: the disk is full or the folder is not "
                      "writable (" +
                      error.what() + "). Choose another with -o."});
  }
}
} // namespace antiform::cases
