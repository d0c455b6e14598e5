// Compiled once per vector level (ANTIFORM_LEVEL names the namespace). Nothing but
// straight loops over local arrays here: g++ turns them into full-width vector code, and
// every level does the same IEEE operations in the same order, so all give the same bits.
#include "discrete/joint_kernel.h"

namespace antiform::discrete::ANTIFORM_LEVEL
{
namespace
{
constexpr std::size_t N = intact_block;

/// Round to the nearest integer by the mantissa's last bit; |x| < 2^51.
inline double nearest(const double x)
{
  constexpr double magic = 6755399441055744.; // 1.5 * 2^52
  return (x + magic) - magic;
}

/// Sine and cosine of n <= N angles: reduction to |r| <= pi/4 in three parts of pi/2,
/// then minimax polynomials (Cephes); error below 1 ulp or so for |angle| < 1e5.
void sine_cosine(const double *angle, double *sine, double *cosine, const std::size_t n)
{
  for (std::size_t i = 0; i < n; ++i)
  {
    const double quarter = nearest(angle[i] * 0.63661977236758134308);
    const double r = ((angle[i] - quarter * 1.57079625129699707031) -
                      quarter * 7.54978941586159635336e-8) -
                     quarter * 5.39030285815811905290e-15;
    const double z = r * r;
    const double s = r + r * z *
                             (-1.66666666666666307295e-1 +
                              z * (8.33333333332211858878e-3 +
                                   z * (-1.98412698295895385996e-4 +
                                        z * (2.75573136213857245213e-6 +
                                             z * (-2.50507477628578072866e-8 +
                                                  z * 1.58962301576546568060e-10)))));
    const double c = 1. - 0.5 * z +
                     z * z *
                         (4.16666666666665929218e-2 +
                          z * (-1.38888888888730564116e-3 +
                               z * (2.48015872888517045348e-5 +
                                    z * (-2.75573141792967388112e-7 +
                                         z * (2.08757008419747316778e-9 -
                                              z * 1.13585365213876817300e-11)))));
    const double quadrant = quarter - 4. * nearest(0.25 * quarter); // -2, -1, 0, 1 or 2
    const bool odd = quadrant * quadrant == 1.;
    const double sine_part = odd ? c : s, cosine_part = odd ? s : c;
    const bool turned = quadrant * quadrant == 4.;
    sine[i] = (turned || quadrant == -1.) ? -sine_part : sine_part;
    cosine[i] = (turned || quadrant == 1.) ? -cosine_part : cosine_part;
  }
}

void lines(const double *x,
           const double *y,
           const double *rotation,
           GrainLine *line,
           const std::size_t begin,
           const std::size_t end)
{
  double half[N], sine[N], cosine[N];
  for (std::size_t block = begin; block < end; block += N)
  {
    const std::size_t n = end - block < N ? end - block : N;
    for (std::size_t i = 0; i < n; ++i)
      half[i] = 0.5 * rotation[block + i];
    sine_cosine(half, sine, cosine, n);
    for (std::size_t i = 0; i < n; ++i)
      line[block + i] = {x[block + i], y[block + i], rotation[block + i],
                         cosine[i],    sine[i],      {}};
  }
}

/// Relative displacements and half angles of some joints' grains, as columns.
struct alignas(64) Columns
{
  double ux[N], uy[N], theta[N], c1[N], s1[N], c2[N], s2[N];
};

void gather(const IntactKernelInput &in,
            const std::size_t begin,
            const std::size_t n,
            Columns &columns)
{
  for (std::size_t k = 0; k < n; ++k)
  {
    const GrainLine &one = in.grains[in.first[begin + k]];
    const GrainLine &two = in.grains[in.second[begin + k]];
    columns.ux[k] = two.x - one.x;
    columns.uy[k] = two.y - one.y;
    columns.theta[k] = two.rotation - one.rotation;
    columns.c1[k] = one.half_cos;
    columns.s1[k] = one.half_sin;
    columns.c2[k] = two.half_cos;
    columns.s2[k] = two.half_sin;
    // Two cache lines a joint, scalar by scalar: g++ would shuffle them into vectors,
    // which takes twice as long.
    asm volatile("");
  }
}

template <bool weighted, bool prestressed>
std::size_t intact_law(const IntactKernelInput &in,
                       const std::size_t begin,
                       const std::size_t n,
                       std::int32_t *over)
{
  Columns columns;
  gather(in, begin, n, columns);
  const double *const ux = columns.ux, *const uy = columns.uy;
  const double *const theta = columns.theta, *const c1 = columns.c1;
  const double *const s1 = columns.s1, *const c2 = columns.c2, *const s2 = columns.s2;

  const double *const normal_x = in.normal_x + begin, *const normal_y =
                                                          in.normal_y + begin;
  const double *const length = in.length + begin;
  const double *const lever = in.lever_difference + begin;
  const double *const stiffness = in.stiffness + begin;
  const double *const half_length = in.half_length + begin;
  const double shear_ratio = in.shear_ratio, moment_factor = in.moment_factor;
  const double outer = in.outer_centroid, tan_friction = in.tan_friction;
  alignas(64) double fx[N], fy[N], t1[N], t2[N], worst[N], coulomb[N];
  const double tensile_strength = in.tensile_strength, cohesion = in.cohesion;
  for (std::size_t k = 0; k < n; ++k)
  {
    // Half angles add: the mean frame is turned by (theta1 + theta2)/2, the faces stand
    // theta/2 to either side of it.
    const double frame_cos = c1[k] * c2[k] - s1[k] * s2[k];
    const double frame_sin = c1[k] * s2[k] + s1[k] * c2[k];
    const double face_cos = c1[k] * c2[k] + s1[k] * s2[k];
    const double face_sin = c1[k] * s2[k] - s1[k] * c2[k];
    const double nx = frame_cos * normal_x[k] - frame_sin * normal_y[k];
    const double ny = frame_sin * normal_x[k] + frame_cos * normal_y[k];

    const double gap = ux[k] * nx + uy[k] * ny - 2. * length[k] * (s1[k] * s2[k]);
    const double shear =
        (uy[k] * nx - ux[k] * ny) - length[k] * frame_sin - lever[k] * face_sin;
    double elastic_gap = gap, elastic_shear = shear, elastic_rotation = theta[k];
    if (prestressed)
    {
      elastic_gap += in.initial_gap[begin + k];
      elastic_shear += in.initial_shear[begin + k];
      elastic_rotation += in.initial_rotation[begin + k];
    }

    const double full = 2. * half_length[k];
    double area_stiffness = stiffness[k] * full;
    const double normal_stress = stiffness[k] * elastic_gap;
    const double bending = stiffness[k] * elastic_rotation;
    worst[k] =
        normal_stress + (bending < 0. ? -bending : bending) * half_length[k] * outer;
    const double shear_stress = stiffness[k] * shear_ratio * elastic_shear;
    coulomb[k] =
        (shear_stress < 0. ? -shear_stress : shear_stress) + worst[k] * tan_friction;
    if (weighted)
      area_stiffness *= in.weight[begin + k];
    const double F = area_stiffness * elastic_gap;
    const double S = area_stiffness * shear_ratio * elastic_shear;
    const double M = -area_stiffness * full * full * moment_factor * elastic_rotation;

    // Force on the second grain: -F n - S t, at the middle of the two faces.
    fx[k] = S * ny - F * nx;
    fy[k] = -F * ny - S * nx;
    const double r1 = 0.5 * (length[k] - lever[k]), r2 = 0.5 * (length[k] + lever[k]);
    t1[k] = (r1 * face_cos + 0.5 * gap) * S - (0.5 * shear - r1 * face_sin) * F - M;
    t2[k] = (r2 * face_cos + 0.5 * gap) * S - (0.5 * shear + r2 * face_sin) * F + M;
  }

  for (std::size_t k = 0; k < n; ++k)
    in.force[begin + k] = {fx[k], fy[k], t1[k], t2[k]};

  // Tension first, then Coulomb: the outer element in tension is the first for both.
  long any = 0;
  for (std::size_t k = 0; k < n; ++k)
    any |= static_cast<long>(worst[k] >= tensile_strength) |
           static_cast<long>(coulomb[k] > cohesion);
  std::size_t n_over = 0;
  for (std::size_t k = 0; any != 0 && k < n; ++k)
    if (worst[k] >= tensile_strength || coulomb[k] > cohesion)
      over[n_over++] = static_cast<std::int32_t>(begin + k);
  return n_over;
}

std::size_t intact(const IntactKernelInput &in,
                   const std::size_t begin,
                   const std::size_t end,
                   std::int32_t *over)
{
  const std::size_t n = end - begin;
  if (in.weight != nullptr)
    return in.initial_gap != nullptr ? intact_law<true, true>(in, begin, n, over)
                                     : intact_law<true, false>(in, begin, n, over);
  return in.initial_gap != nullptr ? intact_law<false, true>(in, begin, n, over)
                                   : intact_law<false, false>(in, begin, n, over);
}
} // namespace

#define ANTIFORM_TEXT(x) #x
#define ANTIFORM_NAME(x) ANTIFORM_TEXT(x)
KernelLevel kernel_level()
{
  return {ANTIFORM_NAME(ANTIFORM_LEVEL) + 6, intact, lines};
}
} // namespace antiform::discrete::ANTIFORM_LEVEL
