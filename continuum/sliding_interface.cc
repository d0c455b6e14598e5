#include "continuum/sliding_interface.h"

#include "continuum/by_place.h"
#include "continuum/section_mesh.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>

namespace antiform::continuum
{
using namespace dealii;
using GlobalDof = types::global_dof_index;

namespace
{
/// A node of an inner face, seen from one cell.
struct FaceNode
{
  double x, y;
  double normal_x, normal_y; ///< outward, times the length of the face
  double cell;               ///< shorter side of the cell [m]
  GlobalDof dof_x, dof_y;

  template <class Archive>
  void serialize(Archive &archive, unsigned int)
  {
    archive &x &y &normal_x &normal_y &cell &dof_x &dof_y;
  }
};

/// Of the cells that this rank owns.
std::vector<FaceNode> own_face_nodes(const DisplacementSpace &solid)
{
  const auto &fe = solid.fe();
  const unsigned int n = fe.n_dofs_per_face();
  FEFaceValues<2> values(fe, QGauss<1>(1), update_normal_vectors | update_JxW_values);
  std::vector<GlobalDof> dofs(n);
  std::vector<FaceNode> nodes;
  for (const auto &cell : solid.dof_handler().active_cell_iterators())
    if (cell->is_locally_owned())
      for (const unsigned int f : cell->face_indices())
        if (cell->at_boundary(f) && cell->face(f)->boundary_id() == boundary::inner)
        {
          values.reinit(cell, f);
          const Tensor<1, 2> normal = values.JxW(0) * values.normal_vector(0);
          cell->face(f)->get_dof_indices(dofs);
          std::map<unsigned int, FaceNode> of_shape; // by number of the shape function
          for (unsigned int i = 0; i < n; ++i)
          {
            const auto [component, shape] = fe.face_system_to_component_index(i, f);
            FaceNode &node = of_shape[shape];
            (component == 0 ? node.dof_x : node.dof_y) = dofs[i];
          }
          for (auto &[shape, node] : of_shape)
          {
            const Point<2> place = solid.support_point(node.dof_x);
            node.x = place[0];
            node.y = place[1];
            node.normal_x = normal[0];
            node.normal_y = normal[1];
            node.cell = cell->minimum_vertex_distance();
            nodes.push_back(node);
          }
        }
  return nodes;
}

/// Nodes of all ranks on one side (faces that look up, or down), each once, with the sum
/// of its faces' normals; ascending in x.
std::vector<FaceNode> merged(const std::vector<std::vector<FaceNode>> &parts,
                             const bool looks_up)
{
  std::map<GlobalDof, FaceNode> by_dof;
  for (const std::vector<FaceNode> &part : parts)
    for (const FaceNode &node : part)
      if ((node.normal_y > 0.) == looks_up)
      {
        const auto [entry, is_new] = by_dof.emplace(node.dof_x, node);
        if (!is_new)
        {
          entry->second.normal_x += node.normal_x;
          entry->second.normal_y += node.normal_y;
          entry->second.cell = std::min(entry->second.cell, node.cell);
        }
      }
  std::vector<FaceNode> nodes;
  for (const auto &[dof, node] : by_dof)
    nodes.push_back(node);
  sort_by_place(nodes);
  return nodes;
}

} // namespace

std::vector<Tie> sliding_interfaces(const DisplacementSpace &solid)
{
  const auto parts = Utilities::MPI::all_gather(solid.dof_handler().get_communicator(),
                                                own_face_nodes(solid));
  const std::vector<FaceNode> lower = merged(parts, true), upper = merged(parts, false);
  std::vector<Tie> ties;
  for (const FaceNode &node : upper)
  {
    const FaceNode *const below =
        at_place(lower, node.x, node.y, same_place * node.cell);
    if (below == nullptr || lower.size() != upper.size()) // seen alike by all ranks
      throw std::invalid_argument(
          "sliding interface: the node at x = " + std::to_string(node.x) +
          " m, y = " + std::to_string(node.y) + " m has no partner.");
    if (!solid.locally_owned().is_element(node.dof_y))
      continue;
    Tie tie{node.dof_y, {{below->dof_y, 1.}}};
    if (const double slope = node.normal_x / node.normal_y; slope != 0.)
    {
      tie.masters.emplace_back(below->dof_x, slope);
      tie.masters.emplace_back(node.dof_x, -slope);
    }
    ties.push_back(std::move(tie));
  }
  return ties;
}
} // namespace antiform::continuum
