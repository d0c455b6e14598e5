// Case 55: what dashpots on a face send back of plane waves, along its normal and aslant.
#include "support/column_fixture.h"
#include "support/files.h"
#include "support/wave_fixtures.h"

#include <gtest/gtest.h>

namespace antiform::testing::absorbing_boundary_tests
{
using namespace coupling;

namespace
{
/// rho = 1 and c_p = 1: rho c_p^2 = E (1 - nu) / ((1 + nu)(1 - 2 nu)).
ElasticMaterial unit_material(const double nu)
{
  return ElasticMaterial::isotropic((1. + nu) * (1. - 2. * nu) / (1. - nu), nu, 1.);
}
double shear_speed(const double nu)
{
  return std::sqrt((1. - 2. * nu) / (2. * (1. - nu)));
}

/// A pulse in a row of square cells of side 1, from x = 50 towards the face at x = 100:
/// the row is a chain of masses rho h and springs rho c^2 / h, whose waves are
/// exp i(w t - k x) with sin(w dt / 2) = (c dt / h) sin(k h / 2).
struct Pulse
{
  unsigned int component; ///< 0: P wave, 1: S wave
  double speed;
  double dt = 0.5 / speed;
  static constexpr double length = 100., start = 50., width = 3.;

  double frequency(const double k) const
  {
    return 2. / dt * std::asin(speed * dt * std::sin(0.5 * k));
  }
  double amplitude(const double k) const
  {
    return std::exp(-0.5 * k * k * width * width);
  }
  /// Sum over the spectrum of @p f(k); 5 widths of it, steps that repeat every 600 cells.
  template <class F>
  double sum(const F &f) const
  {
    const double step = 2. * M_PI / 600.;
    double total = 0.;
    for (double k = 0.5 * step; k < 5. / width; k += step)
      total += step * amplitude(k) * f(k);
    return total;
  }
  double displacement(const double x, const double t) const
  {
    return sum([&](const double k)
               { return std::cos(k * (x - start) - frequency(k) * t); });
  }

  /// Of the energy, sent back by a dashpot rho c at the chain's end: the chain's
  /// impedance there is rho c q, q = cos(k h / 2) / cos(w dt / 2), so that an amplitude
  /// (q - 1) / (q + 1) comes back; a wave's energy goes as (amplitude sin w dt)^2.
  double returned() const
  {
    const auto energy = [&](const double k)
    { return amplitude(k) * std::pow(std::sin(frequency(k) * dt), 2); };
    const double back = sum(
        [&](const double k)
        {
          const double q = std::cos(0.5 * k) / std::cos(0.5 * frequency(k) * dt);
          return energy(k) * std::pow((q - 1.) / (q + 1.), 2);
        });
    return back / sum(energy);
  }

  void send(WaveBody &body) const
  {
    body.hold(1 - component, [](const Point<2> &) { return true; });
    body.start([&](const Point<2> &p, const unsigned int c)
               { return c == component ? displacement(p[0], 0.) : 0.; },
               [&](const Point<2> &p, const unsigned int c)
               {
                 return c == component
                            ? (displacement(p[0], 0.) - displacement(p[0], -dt)) / dt
                            : 0.;
               });
  }
  /// Until the pulse is, or would be, back where it was.
  std::int64_t n_steps() const
  {
    return std::llround(2. * (length - start) / speed / dt);
  }
};

void make_row(Triangulation &triangulation)
{
  make_rectangle(triangulation, Pulse::length, 1., 100, 1);
}

std::vector<Pulse> pulses()
{
  return {{0, 1.}, {1, shear_speed(0.25)}};
}
} // namespace

TEST(AbsorbingBoundary, TakesPulsesAlongItsNormal)
{
  for (const Pulse &pulse : pulses())
  {
    WaveBody body(make_row, unit_material(0.25));
    pulse.send(body);
    body.make_loop(pulse.dt, {boundary::right});
    const auto ledger = body.advance(pulse.n_steps(), 1000);
    const double returned = stored(ledger.back()) / stored(ledger.front());
    EXPECT_LT(returned, 1e-3);
    // The wave equation sends back nothing, cells of a third of the pulse's width this.
    // Spectrum and start are those of the chain: what is left is the pulse's tail.
    EXPECT_NEAR(returned, pulse.returned(), 1e-3 * pulse.returned())
        << "component " << pulse.component;
  }
}

TEST(AbsorbingBoundary, WithoutItAHeldFaceSendsAllBack)
{
  for (const Pulse &pulse : pulses())
  {
    WaveBody body(make_row, unit_material(0.25));
    pulse.send(body);
    body.hold(pulse.component,
              [](const Point<2> &p) { return p[0] > Pulse::length - 1e-9; });
    body.make_loop(pulse.dt, {});
    const auto ledger = body.advance(pulse.n_steps(), 1000);
    EXPECT_NEAR(stored(ledger.back()), stored(ledger.front()),
                1e-12 * stored(ledger.front())); // round-off
    // Wave and mirror image, which cancel at the face.
    const double time = static_cast<double>(pulse.n_steps()) * pulse.dt;
    const auto expected = interpolate(
        body.solid(),
        [&](const Point<2> &p, const unsigned int c)
        {
          return c != pulse.component
                     ? 0.
                     : pulse.displacement(p[0], time) -
                           pulse.displacement(2. * Pulse::length - p[0], time);
        });
    auto difference = body.mesh().displacement;
    difference -= expected;
    EXPECT_LT(difference.linfty_norm(), 1e-6 * expected.linfty_norm());
  }
}

namespace
{
/// What a face with tractions -rho c_p v_n, -rho c_s v_t returns of the energy of a plane
/// P wave at @p angle from its normal; rho = c_p = 1.
///
/// Waves a d g(t - p.x / c) with direction p and motion d have the velocity a d g' and
/// the stress -(lambda (d.p) 1 + mu (d p + p d)) a g' / c. With s, S the sines of the
/// angles of P and S waves, S = c_s s, and c, C their cosines,
///           p           d         sigma_xx           sigma_xy
///   in:     (c, s)      p         -(1 - 2 c_s^2 s^2)   -2 c_s^2 s c
///   P out:  (-c, s)     p         -(1 - 2 c_s^2 s^2)    2 c_s^2 s c
///   S out:  (-C, S)     (S, C)     2 c_s S C            c_s (C^2 - S^2)
/// since lambda + 2 mu c^2 = 1 - 2 c_s^2 s^2. The two tractions on the face x = 0,
/// sigma_xx + v_x = 0 and sigma_xy + c_s v_y = 0, give the amplitudes of the waves out.
/// Energy flows through the face at rho c v^2 times the cosine.
double returned_aslant(const double angle, const double nu)
{
  const double c_s = shear_speed(nu), s = std::sin(angle), c = std::cos(angle),
               S = c_s * s, C = std::sqrt(1. - S * S);
  const double normal = 1. - 2. * c_s * c_s * s * s, shear = 2. * c_s * c_s * s * c;
  // (P, S) amplitudes: a P + b S = e, f P + g S = h.
  const double a = -normal - c, b = 2. * c_s * S * C + S, e = normal - c;
  const double f = shear + c_s * s, g = c_s * (C * C - S * S) + c_s * C,
               h = shear - c_s * s;
  const double determinant = a * g - b * f;
  const double P_out = (e * g - b * h) / determinant,
               S_out = (a * h - e * f) / determinant;
  return P_out * P_out + c_s * C / c * S_out * S_out;
}

/// A train of P waves of length 1 at @p angle, and its mirror image: between y = 0 and
/// 1 / (2 sin angle) both together slide along the sides, as u = grad f with
/// f = F(x, t) cos(k_y y). F is a train of some waves, with their various angles.
struct WaveTrain
{
  double angle, nu;
  static constexpr double width = 1.5; ///< standard deviation of the train [wavelengths]
  double k_y = 2. * M_PI * std::sin(angle), k_x = 2. * M_PI * std::cos(angle);
  double margin = 4. * width; ///< from the middle of the train to either end

  template <class F>
  double sum(const F &f) const
  {
    double total = 0.;
    const double step = 2. * M_PI / (6. * margin); // the sum repeats every 6 margins
    for (int i = -200; i <= 200; ++i)
      if (const double dk = i * step; std::abs(dk) * width < 5.)
        total += std::exp(-0.5 * dk * dk * width * width) * f(k_x + dk);
    return total;
  }
  double frequency(const double k) const { return std::hypot(k, k_y); }
  double returned() const
  {
    const auto energy = [&](const double k)
    {
      const double dk = k - k_x;
      return std::exp(-0.5 * dk * dk * width * width) * std::pow(frequency(k), 4);
    };
    const double back =
        sum([&](const double k)
            { return energy(k) * returned_aslant(std::atan2(k_y, k), nu); });
    return back / sum(energy);
  }
  double displacement(const Point<2> &p, const unsigned int c, const double t) const
  {
    return sum(
        [&](const double k)
        {
          const double phase = k * (p[0] - margin) - frequency(k) * t;
          return c == 0 ? -k * std::sin(phase) * std::cos(k_y * p[1])
                        : -k_y * std::cos(phase) * std::sin(k_y * p[1]);
        });
  }
};

/// The share of the energy that comes back where a wavelength has @p n cells.
double measured_aslant(const WaveTrain &train, const unsigned int n)
{
  const double height = M_PI / train.k_y, length = 2. * train.margin;
  const auto cells = [&](const double side)
  { return static_cast<unsigned int>(std::lround(side * n)); };
  WaveBody body(
      [&](Triangulation &triangulation)
      {
        make_rectangle(triangulation, length, height, cells(length), cells(height));
        dealii::GridTools::shift(Point<2>(0., 0.5 * height), triangulation);
      },
      unit_material(train.nu));
  body.hold(1, [&](const Point<2> &p) { return p[1] < 1e-9 || p[1] > height - 1e-9; });
  const double dt = 0.9 * body.solid().stable_step(body.mesh().inverse_mass);
  body.start([&](const Point<2> &p, const unsigned int c)
             { return train.displacement(p, c, 0.); },
             [&](const Point<2> &p, const unsigned int c) {
               return (train.displacement(p, c, 0.) - train.displacement(p, c, -dt)) / dt;
             });
  body.make_loop(dt, {boundary::right});
  // There and back at the speed along x.
  const double time = 2. * train.margin / std::cos(train.angle);
  const auto ledger = body.advance(std::llround(time / dt), 1000000);
  return stored(ledger.back()) / stored(ledger.front());
}
} // namespace

namespace
{
void expect_closed_form_aslant(const double degrees, const double nu)
{
  const WaveTrain train{degrees * M_PI / 180., nu};
  const double exact = train.returned();
  std::vector<double> returned;
  for (const unsigned int n : {8, 16, 32})
    returned.push_back(measured_aslant(train, n));
  EXPECT_GT(returned[0], returned[1]);
  EXPECT_LT(returned[2], 0.05);
  // Cells add an amplitude of some (k h)^2 / 16: its product with what comes back is of
  // order 2, its square of order 4.
  const double order = std::log2((returned[1] - exact) / (returned[2] - exact));
  EXPECT_GT(order, 1.7);
  EXPECT_LT(order, 2.7);
  // What order 4 leaves: 3e-5, a third of ((k h)^2 / 16)^2 with 16 cells.
  const double limit = returned[2] + (returned[2] - returned[1]) / 3.;
  EXPECT_NEAR(limit, exact, 0.01 * exact + 3e-5);
}
} // namespace

TEST(AbsorbingBoundary, ReturnsAThirdOfAThousandthOfPWavesAt30Degrees)
{
  expect_closed_form_aslant(30., 0.25); // 3.2e-4
}

TEST(AbsorbingBoundary, ReturnsMoreOfPWavesAt30DegreesWithoutPoissonsRatio)
{
  expect_closed_form_aslant(30., 0.); // 6.3e-3
}

TEST(AbsorbingBoundary, ReturnsFourPercentOfPWavesAt60Degrees)
{
  expect_closed_form_aslant(60., 0.25); // 3.8e-2, half of it as S waves
}

TEST(AbsorbingBoundary, ClosedFormOfWavesAslantHasItsLimits)
{
  // Along the normal nothing comes back, along the face all does.
  for (const double nu : {0., 0.25, 0.4})
  {
    EXPECT_NEAR(returned_aslant(0., nu), 0., 1e-15);
    EXPECT_NEAR(returned_aslant(0.5 * M_PI - 1e-6, nu), 1., 1e-4);
  }
  // At 60 degrees and nu = 1/4 both waves have the amplitude sqrt(3)/2 - 1.
  const double amplitude = std::sqrt(0.75) - 1.;
  EXPECT_NEAR(returned_aslant(M_PI / 3., 0.25), 2. * amplitude * amplitude, 1e-15);
}

namespace
{
/// A body on dashpots on all its sides, started off irregularly: energy left after @p n
/// steps over that at first. It is never more, and the ledger tells where it went.
double left_on_dashpots(WaveBody &body, const double dt, const std::int64_t n)
{
  body.start([](const Point<2> &, unsigned int) { return 0.; },
             [](const Point<2> &p, const unsigned int c)
             { return std::sin(40. * p[0] + 7. * c) + std::cos(33. * p[1] - p[0]); });
  body.make_loop(dt, {0, 1, 2, 3});
  const auto ledger = body.advance(n, 1);
  const double all = ledger.front().stored_and_spent();
  for (const Energies &energies : ledger)
  {
    EXPECT_LT(stored(energies), all);
    EXPECT_NEAR(energies.stored_and_spent(), all, 1e-12 * all); // round-off
  }
  return stored(ledger.back()) / all;
}

void make_unit_square(Triangulation &triangulation)
{
  make_rectangle(triangulation, 1., 1., 1, 1);
}
} // namespace

TEST(AbsorbingBoundary, LeavesTheStableStepAsItIs)
{
  // One square: side / c_p sqrt(1 - nu), exact. Its slowest wave has left long ago.
  WaveBody square(make_unit_square, unit_material(0.25));
  EXPECT_LT(std::abs(left_on_dashpots(square, 0.99 * std::sqrt(0.75), 2000)), 1e-14);
  for (const unsigned int degree : {1, 2})
  {
    WaveBody body([](Triangulation &t) { make_distorted_square(t, 5); },
                  unit_material(0.25), degree);
    const double bound = body.solid().stable_step(body.mesh().inverse_mass);
    EXPECT_LT(left_on_dashpots(body, 0.99 * bound, 1000), 0.01) << "degree " << degree;
  }
}

TEST(AbsorbingBoundary, OfTheVelocityBeforeWouldShortenTheStep)
{
  // The same dashpots on the same square, without the solve: -C v of the half step
  // before.
  WaveBody body(make_unit_square, unit_material(0.25));
  body.start([](const Point<2> &, unsigned int) { return 0.; },
             [](const Point<2> &p, const unsigned int c)
             { return c == 0 ? std::sin(40. * p[0]) : std::cos(33. * p[1]); });
  Simulation &loop = body.make_loop(0.99 * std::sqrt(0.75), {});
  const auto dashpots = continuum::absorbing_dashpots(body.solid(), {0, 1, 2, 3});
  MeshState &mesh = body.mesh();
  loop.add(std::make_unique<coupling::test::Every>(
               [&](const Clock &)
               {
                 for (const auto &d : dashpots)
                 {
                   const double vx = mesh.velocity.begin()[d.dof_x],
                                vy = mesh.velocity.begin()[d.dof_y];
                   mesh.force.begin()[d.dof_x] -= d.xx * vx + d.xy * vy;
                   mesh.force.begin()[d.dof_y] -= d.xy * vx + d.yy * vy;
                 }
               }),
           {Stage::damp}, 60, "lagged dashpots", "test");
  const auto ledger = body.advance(200, 199);
  EXPECT_GT(std::abs(stored(ledger.back())), 1e6 * stored(ledger.front()));
}

TEST(AbsorbingBoundary, LedgerClosesWithMovingSupportsAndDamping)
{
  // A wall drives the left side along x, part of the top is held, and all sides have
  // dashpots: their force on prescribed dofs is borne by the supports.
  for (const double damping : {0., 0.3})
  {
    WaveBody body([](Triangulation &t) { make_rectangle(t, 4., 2., 16, 8); },
                  unit_material(0.25));
    discrete::Wall wall;
    wall.normal = {1., 0.};
    body.walls.push_back(wall);
    body.hold(
        0, [](const Point<2> &p) { return p[0] < 1e-9; }, 0);
    body.hold(1, [](const Point<2> &p) { return p[1] > 1. - 1e-9 && p[0] > 2.; });
    const double dt = 0.8 * body.solid().stable_step(body.mesh().inverse_mass);
    body.make_loop(dt, {0, 1, 2, 3}, damping);
    const auto ledger = body.advance(2000, 50);
    const auto gap = [](const Energies &energies)
    { return energies.boundary_work - energies.stored_and_spent(); };
    double worst = 0.;
    for (const Energies &energies : ledger)
      worst = std::max(worst, std::abs(gap(energies) - gap(ledger.front())));
    EXPECT_LT(worst, 1e-12 * ledger.back().magnitude()); // exact: round-off
    EXPECT_GT(ledger.back().damping, 0.5 * ledger.back().boundary_work);
  }
}

TEST(AbsorbingBoundary, RestsUnderALoadThatItIsGivenAndElseCreeps)
{
  // A prestressed row, pressed on its left face and, or not, on its dashpots.
  const double pressure = 1e-3;
  for (const bool is_given : {true, false})
  {
    WaveBody body(make_row, unit_material(0.25));
    body.hold(1, [](const Point<2> &) { return true; });
    Simulation &loop = body.make_loop(0.9, {boundary::right});
    dealii::SymmetricTensor<2, 2> stress;
    stress[0][0] = -pressure;
    continuum::BoundaryIds pressed{boundary::left};
    if (is_given)
      pressed.insert(boundary::right);
    const auto add = [&](const continuum::Vector &load)
    {
      loop.add(std::make_unique<MeshLoads>(body.mesh(), load), {Stage::forces}, 10,
               "loads", "test");
    };
    add(continuum::prestress(body.solid(), stress));
    add(continuum::pressure(body.solid(), pressed, pressure));
    // Unloading runs from the right face to the left and back in 200. What else there is
    // by then, 2 %, are waves of a few cells, which are slow.
    body.advance(450, 1000);
    const double creep = is_given ? 0. : pressure; // over rho c_p
    auto difference = body.mesh().velocity;
    difference -= interpolate(body.solid(), [&](const Point<2> &, const unsigned int c)
                              { return c == 0 ? creep : 0.; });
    EXPECT_LT(difference.linfty_norm(), (is_given ? 1e-12 : 0.05) * pressure);
  }
}

TEST(AbsorbingBoundary, ContinuesFromASavedState)
{
  const antiform::test::TemporaryFolder folder;
  const Pulse pulse = pulses().front();
  std::vector<Energies> last;
  for (const bool resumes : {false, true})
  {
    WaveBody body(make_row, unit_material(0.25));
    pulse.send(body);
    Simulation &loop = body.make_loop(pulse.dt, {boundary::right});
    if (resumes)
    {
      StateReader reader(folder.path("state"));
      loop.visit_state(reader);
      reader.expect_all_read();
    }
    else
    {
      body.advance(105, 1000); // the pulse is at the face
      StateWriter writer;
      loop.visit_state(writer);
      writer.commit(folder.path("state"));
    }
    last.push_back(body.advance(95, 1000).back());
  }
  EXPECT_GT(last[0].damping, 0.99 * last[0].stored_and_spent());
  EXPECT_EQ(last[1].damping, last[0].damping);
  EXPECT_EQ(stored(last[1]), stored(last[0]));
}

TEST(AbsorbingBoundary, ServesAMeshJoinedToGrains)
{
  using namespace coupling::test;
  Column column;
  for (const auto &cell : column.model.triangulation.active_cell_iterators())
    for (const auto &face : cell->face_iterators())
      if (face->at_boundary() && face->center()[0] > column.end - 1e-9)
        face->set_boundary_id(1);
  column.support(0., true);
  MeshState &mesh = *column.model.mesh;
  const ElasticSolid &solid = *column.model.solid;
  const BridgingDomain *const domain = column.model.domain.get();
  // Face 0 is the whole outline, overlap included.
  EXPECT_THROW(AbsorbingBoundary(mesh, continuum::absorbing_dashpots(solid, {0}), domain),
               std::invalid_argument);

  Loop run(column.model, 0.9 * column.model.stable_step(), {});
  run.add(std::make_unique<AbsorbingBoundary>(
              mesh, continuum::absorbing_dashpots(solid, {1}), domain),
          {Stage::damp, Stage::kick, Stage::drift}, 60, "dashpots");
  white_noise(column.model, 1e-9, 55);
  std::vector<Energies> ledger;
  run.probe(20, [&](const Clock &) { ledger.push_back(run.simulation.energies()); });
  run.advance(4001);
  const double all = ledger.front().stored_and_spent();
  double worst = 0.;
  for (const Energies &energies : ledger)
    worst = std::max(worst, std::abs(energies.stored_and_spent() / all - 1.));
  EXPECT_LT(worst, 1e-6);
  EXPECT_GT(ledger.back().damping, 0.3 * all);
}
} // namespace antiform::testing::absorbing_boundary_tests
