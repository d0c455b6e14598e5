#pragma once

#include "cases/declarations.h"

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

namespace antiform::cases
{
/// All that a deck may say, with its defaults.
class AllParameters
{
public:
  AllParameters()
  {
    std::vector<std::string> names;
    for (const Section &section : all_sections())
      names.push_back(section.name);
    declare_parameters(defaults_, names, declarations_);
  }
  const std::vector<Declarations::Entry> &entries() const
  {
    return declarations_.entries();
  }
  /// Null: there is no such entry.
  const Declarations::Entry *find(const std::string &path) const
  {
    return declarations_.find(path);
  }

private:
  Parameters defaults_;
  dealii::ParameterHandler prm_;
  Declarations declarations_{prm_};
};
} // namespace antiform::cases
