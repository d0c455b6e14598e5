#pragma once

#include "cases/geometry.h"
#include "cases/parameters.h"
#include "coupling/output/vtu.h"

#include <mpi.h>

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace antiform::cases
{
/// One of the lowest loads of a section.
struct Mode
{
  double shortening;       ///< [-]
  double stress;           ///< of the layer [Pa]
  unsigned int half_waves; ///< along the section
};

/// A straight section between its end walls, of whatever it is made, and how it buckles.
/// Collective.
class StraightSection
{
public:
  /// \param parameters outlive the section
  explicit StraightSection(const Parameters &parameters)
      : p_(parameters)
      , geometry_(parameters)
  {
  }
  virtual ~StraightSection() = default;

  const Parameters &parameters() const { return p_; }
  const SectionGeometry &geometry() const { return geometry_; }
  virtual MPI_Comm communicator() const = 0;
  /// As Summary::sizes.
  virtual std::map<std::string, std::int64_t> sizes() const = 0;

  /// Lowest loads and shapes. \param stop asked now and then; true ends the search by
  /// continuum::BucklingStopped.
  virtual void solve(const std::function<bool()> &stop) = 0;
  /// Of the last solve(), ascending.
  const std::vector<Mode> &modes() const { return modes_; }
  /// E' that the straight layer shows: its stress over the shortening [Pa].
  double plane_modulus() const
  {
    return modes_.front().stress / modes_.front().shortening;
  }
  /// Write field files of all modes, and of the straight section where it is not even,
  /// below @p directory; what fields.pvd has to list.
  virtual std::vector<coupling::PvdEntry>
  write_fields(const std::string &directory) const = 0;
  /// What a reader should know of this kind of section before he believes the figures.
  virtual std::vector<std::string> doubts() const { return {}; }

  /// Estimated relative error of the lowest load times a factor of some 2 to 10 [-].
  virtual double estimate() const { return 0.; }
  /// Refine where the lowest modes are in error, which are gone then. False: there is
  /// nothing to refine.
  virtual bool refine() { return false; }

protected:
  const Parameters &p_;
  SectionGeometry geometry_;
  std::vector<Mode> modes_;
};
} // namespace antiform::cases
