// Contacts that a scene makes of grains without joints.
#include "cases/parameters.h"
#include "cases/scene.h"
#include "support/tiny_run.h"

#include <mpi.h>

#include <algorithm>

namespace contacts_of_scenes_tests
{
using namespace antiform;
using namespace antiform::test;

namespace
{
std::unique_ptr<cases::Scene> scene_of(const std::vector<std::string> &overrides)
{
  return cases::build(cases::read_deck(tiny_deck(), overrides), MPI_COMM_SELF,
                      [](const std::string &) {});
}

bool has_group(const discrete::Contacts &contacts, const int one, const int other)
{
  return std::any_of(contacts.groups.begin(), contacts.groups.end(),
                     [&](const discrete::ContactGroup &group)
                     { return group.region_i == one && group.region_j == other; });
}
} // namespace

TEST(ContactsOfScenes, MatrixGrainsMeetWhereTheirJointsMayBreak)
{
  for (const bool breakable : {false, true})
  {
    std::vector<std::string> entries{"Matrix/Tensile strength=1e5",
                                     "Matrix/Cohesion=4e5"};
    entries.push_back(std::string("Matrix/Breakable=") + (breakable ? "true" : "false"));
    const auto scene = scene_of(entries);
    scene->add_breakage_components();
    EXPECT_TRUE(has_group(scene->contacts, cases::layer_region, cases::layer_region));
    EXPECT_EQ(has_group(scene->contacts, cases::matrix_region, cases::matrix_region),
              breakable);
  }
}

TEST(ContactsOfScenes, UnbondedInterfaceCarriesTheSurfacePressure)
{
  const double pressure = 1e6;
  const auto scene = scene_of({"Matrix/Interface=frictionless", "Layer/Breakable=true",
                               "Components=layer, matrix, surface pressure, walls, "
                               "damping",
                               "Surface pressure/Pressure=1e6"});
  for (int step = 0; step < 2; ++step)
  {
    const discrete::Grains &grains = scene->grains->state.grains;
    double above = 0., below = 0.;
    for (const discrete::Contact &contact : scene->contacts.contacts)
    {
      const Vec2 branch =
          grains.position(contact.second) - grains.position(contact.first);
      const double y =
          0.5 * (grains.reference_y[contact.first] + grains.reference_y[contact.second]);
      (y > 0. ? above : below) +=
          contact.normal_force * std::abs(branch.y) / norm(branch);
    }
    // The prestress of a contact is that of the mean stress of a packing; along one line
    // of contacts it scatters: 0.84 of the pressure were seen.
    const double whole = pressure * scene->geometry.length();
    EXPECT_NEAR(above / whole, 1., 0.25);
    EXPECT_NEAR(below / whole, 1., 0.25);
    // The law of broken bonds joins, and the prestress is still there.
    scene->add_breakage_components();
    scene->simulation->step();
  }
}
} // namespace contacts_of_scenes_tests
