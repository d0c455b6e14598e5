#include "coupling/state_file.h"

#include "coupling/output/whole_file.h"

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <functional>
#include <stdexcept>
#include <utility>

namespace antiform::coupling
{
namespace
{
const char *const ranks_name = "ranks"; // how many wrote the file

namespace ranks = dealii::Utilities::MPI;

void check_name(const std::string &name)
{
  const std::string path = '/' + name + '/';
  if (name == state_contents_name || name == ranks_name ||
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
  std::string bytes;
  try
  {
    bytes = state_bytes(entries);
  }
  catch (const std::runtime_error &error)
  {
    throw std::runtime_error("'" + path + "' cannot be composed: " + error.what() + ".");
  }
  replace_file(path, bytes);
}

const char *type_name(const std::size_t kind)
{
  const std::array<const char *, 3> names{"numbers", "integers", "text"};
  return names[kind];
}
} // namespace

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
                  const std::string problem = problem_of_state(bytes);
                  if (!problem.empty())
                    throw std::runtime_error("'" + path +
                                             "' cannot be resumed from: " + problem);
                });
  bytes = ranks::broadcast(communicator, bytes);
  try
  {
    entries_ = parse_state(std::move(bytes));
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
