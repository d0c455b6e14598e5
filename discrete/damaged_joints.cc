#include "discrete/joint_kernel.h"
#include "discrete/joints.h"
#include "discrete/lanes.h"

namespace antiform::discrete
{
static_assert(n_lanes == 4, "the layout of DamagedJoints");

void DamagedJoints::make_room(const int n)
{
  if (n <= n_elements_)
    return;
  DamagedJoints old = *this;
  n_elements_ = n;
  bonds_.assign(joint.size() * static_cast<std::size_t>(n), Bond::unbonded);
  slips_.assign(bonds_.size(), 0.);
  for (std::size_t k = 0; k < size_; ++k)
    for (int e = 0; e < old.n_elements_; ++e)
    {
      set_bond(k, e, old.bond(k, e));
      set_slip(k, e, old.slip(k, e));
    }
}

std::size_t DamagedJoints::append(const std::size_t j, const std::size_t g, const int n)
{
  make_room(n);
  const std::size_t k = size_++;
  if (size_ > joint.size())
  {
    const std::size_t room = joint.size() + n_lanes;
    joint.resize(room, static_cast<std::int32_t>(j));
    group.resize(room, static_cast<std::int32_t>(g));
    removed.resize(room, 1);
    for (std::vector<double> *v :
         {&gap, &shear, &rotation, &slip_energy, &fracture_energy})
      v->resize(room, 0.);
    force.resize(room, {0., 0., 0., 0.});
    bonds_.resize(room * static_cast<std::size_t>(n_elements_), Bond::unbonded);
    slips_.resize(bonds_.size(), 0.);
  }
  joint[k] = static_cast<std::int32_t>(j);
  group[k] = static_cast<std::int32_t>(g);
  removed[k] = 0;
  gap[k] = shear[k] = rotation[k] = slip_energy[k] = fracture_energy[k] = 0.;
  force[k] = {0., 0., 0., 0.};
  for (int e = 0; e < n_elements_; ++e)
  {
    set_bond(k, e, e < n ? Bond::bonded : Bond::unbonded);
    set_slip(k, e, 0.);
  }
  return k;
}

void DamagedJoints::pop_back()
{
  removed[--size_] = 1;
}

JointWork::JointWork() = default;
JointWork::~JointWork() = default;
JointWork::JointWork(const JointWork &) = default;
JointWork::JointWork(JointWork &&) noexcept = default;
JointWork &JointWork::operator=(const JointWork &) = default;
JointWork &JointWork::operator=(JointWork &&) noexcept = default;
} // namespace antiform::discrete
