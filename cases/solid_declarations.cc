// The entries of finite elements: cells, materials, what carries them and lets waves out.
#include "cases/declarations.h"

namespace antiform::cases
{
void declare_mesh(MatrixParameters &matrix, const bool bare, Declarations &entries)
{
  entries.number("Cell size ratio", matrix.cell_size,
                 "Size of the cells in and near the layer over the mean grain diameter "
                 "[-].",
                 Number::above(0.));
  if (!bare)
    entries.number(
        "Largest cell ratio", matrix.largest_cell,
        "Height of the cells away from the layer over the mean grain diameter [-].",
        Number::above(0.));
  entries.number("Cell aspect ratio", matrix.cell_aspect,
                 "Width of the columns of cells over the size of the cells near the "
                 "layer; more than 1 only without grains [-].",
                 Number::at_least(1.));
  entries.whole("Element degree", matrix.element_degree,
                "Polynomial degree of the finite elements [-].", Number::between(1, 2));
  if (!bare)
  {
    entries.whole("Cover rows", matrix.cover_rows,
                  "Even rows of cells in the cover; 0: as many as the size of the cells "
                  "asks for, and a cover thinner than one is refused (it gets a row where "
                  "'Join' is automatic). More than 0 only without matrix grains [-].",
                  Number::at_least(0.));
    entries.number("Contact stiffness ratio", matrix.contact_stiffness,
                   "Static driver: stiffness of an interface of finite elements that is "
                   "not cemented over that of the cells beside it; what a contact gives "
                   "way under load falls as its inverse [-].",
                   Number::above(0.));
  }
  entries.whole("Refinement rounds", matrix.refinement_rounds,
                "Buckling driver: how often to cut the cells in four where the estimated "
                "error of the lowest mode is large, and solve again [-].",
                Number::between(0., 12.));
  entries.number("Refinement share", matrix.refinement_share,
                 "Share of the estimated error that the cells which a round refines hold "
                 "[-].",
                 Number::above(0.).up_to(1.));
}

void declare(const std::string &section,
             MaterialParameters &material,
             Declarations &entries)
{
  entries.enter(section);
  entries.choice("Law", material.law,
                 "elastic (Hooke; neo-Hookean at finite strain), St Venant-Kirchhoff "
                 "(finite strain; soft under strong compression), Mohr-Coulomb and "
                 "Drucker-Prager (elastic, perfectly plastic), Maxwell (viscous in "
                 "shear). At finite strain the last three are for large rotation and "
                 "strains of some percents. Other than elastic: static driver.",
                 "elastic|St Venant-Kirchhoff|Mohr-Coulomb|Drucker-Prager|Maxwell");
  entries.number(
      "Cohesion", material.cohesion,
      "c of Mohr-Coulomb and Drucker-Prager, 2 c cos phi / (1 - sin phi) being "
      "the UCS [Pa].",
      Number::at_least(0.));
  entries.angle("Friction angle", material.tan_friction, "phi [degrees].");
  entries.angle("Dilation angle", material.tan_dilation,
                "psi, up to phi; with psi = phi flow is associated [degrees].");
  entries.number("Tensile strength", material.tensile_strength,
                 "Cut-off of Mohr-Coulomb, up to c cot phi; 0: none [Pa].",
                 Number::at_least(0.));
  entries.choice("Match", material.match,
                 "Where the cone of Drucker-Prager meets Mohr-Coulomb: plane strain (of "
                 "equal collapse with psi = phi, or psi = 0), outer (triaxial "
                 "compression), inner (extension).",
                 "plane strain|outer|inner");
  entries.number("Viscosity", material.viscosity, "eta of Maxwell in shear [Pa s].",
                 Number::above(0.));
  entries.leave();
}

void declare(FoundationParameters &foundation, Declarations &entries)
{
  entries.enter("Foundation");
  entries.number(
      "Stiffness ratio", foundation.stiffness_ratio,
      "k_w h/E0, stiffness of the elastic (Winkler) foundation over that of the matrix "
      "[-].",
      Number::above(0.));
  entries.number("Stiffness", foundation.stiffness,
                 "k_w itself; 0: from the ratio. A layer without matrix needs it [Pa/m].",
                 Number::at_least(0.));
  entries.number("Shear ratio", foundation.shear_ratio,
                 "G_p/(k_w h^2), Pasternak's shear layer, by which neighbouring springs "
                 "hold one another; 0: none [-].",
                 Number::at_least(0.));
  entries.choice("Faces", foundation.faces, "Which faces of the section it carries.",
                 "base|top|base and top");
  entries.flag("Lifts off", foundation.lifts_off,
               "Does it push only, so that the section may part from it? Static driver.");
  entries.leave();
}

void declare(AbsorbingBoundaryParameters &boundary, Declarations &entries)
{
  entries.enter("Absorbing boundary");
  entries.choice("Faces", boundary.faces,
                 "Faces that let waves out, by dashpots in place of a support.",
                 "base|top|base and top");
  entries.leave();
}
} // namespace antiform::cases
