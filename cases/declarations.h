#pragma once

#include "cases/parameters.h"

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/patterns.h>

#include <memory>
#include <string>
#include <vector>

namespace antiform::cases
{
/// A number with bounds that may be open, whole or not; says its range in words.
class Number final : public dealii::Patterns::PatternBase
{
public:
  static Number any();
  static Number above(double lower);
  static Number at_least(double lower);
  static Number between(double lower, double upper); ///< both included
  Number below(double upper) const; ///< the same with an upper bound, not included
  Number up_to(double upper) const; ///< the same with an upper bound, included
  Number whole() const;             ///< the same, whole numbers only

  bool match(const std::string &text) const override;
  std::string description(OutputStyle style = Machine) const override;
  std::unique_ptr<PatternBase> clone() const override;

private:
  double lower_, upper_;
  bool lower_open_ = false, upper_open_ = false, whole_ = false;
};

/// Numbers of a range between commas; none at all is a list too.
class NumberList final : public dealii::Patterns::PatternBase
{
public:
  explicit NumberList(const Number &range)
      : range_(range)
  {
  }
  bool match(const std::string &text) const override;
  std::string description(OutputStyle style = Machine) const override;
  std::unique_ptr<PatternBase> clone() const override;
  static std::vector<std::string> split(const std::string &text);

private:
  Number range_;
};

/// A number > 0 and <= 100 with a percent sign, "5 %"; or nothing.
class Percentage final : public dealii::Patterns::PatternBase
{
public:
  bool match(const std::string &text) const override;
  std::string description(OutputStyle style = Machine) const override;
  std::unique_ptr<PatternBase> clone() const override;
  /// \param[out] percent 0 for nothing
  static bool parse(const std::string &text, double &percent);
};

/// The number that @p text is, all of it; false when it is none, or not finite.
bool parse_number(const std::string &text, double &number);

/// The shortest text that reads back as the same bits.
std::string exact_text(double number);

/// The angle [degrees] whose tangent, as tangent_of_degrees() computes it, is @p tangent:
/// the shortest one, so that 8 degrees stays 8.
double degrees_of_tangent(double tangent);
double tangent_of_degrees(double degrees);

/// Declares the members of parameter structs to a ParameterHandler and keeps the patterns
/// at hand, so that a refusal can say the range in words. Not add_parameter(): that
/// prints a default with six digits and reads it back into the struct. Binds addresses:
/// declare, set and let go in one scope.
class Declarations
{
public:
  struct Entry
  {
    std::string path; ///< "Section/Subsection/Entry"
    std::string default_value;
    std::string documentation; ///< the unit in brackets
    std::shared_ptr<dealii::Patterns::PatternBase> pattern;
  };

  explicit Declarations(dealii::ParameterHandler &prm)
      : prm_(prm)
  {
  }

  void enter(const std::string &section);
  void leave();
  void number(const std::string &name,
              double &value,
              const std::string &documentation,
              const Number &range);
  void whole(const std::string &name,
             int &value,
             const std::string &documentation,
             const Number &range);
  /// @p words "a|b|c"
  void choice(const std::string &name,
              std::string &value,
              const std::string &documentation,
              const std::string &words);
  void flag(const std::string &name, bool &value, const std::string &documentation);
  void
  text(const std::string &name, std::string &value, const std::string &documentation);
  void list(const std::string &name,
            std::vector<std::string> &value,
            const std::string &documentation);
  void numbers(const std::string &name,
               std::vector<double> &value,
               const std::string &documentation,
               const Number &range);
  /// In the deck "5 %", or nothing for 0.
  void
  percentage(const std::string &name, double &percent, const std::string &documentation);
  /// In the deck an angle in degrees, in the struct its tangent.
  void angle(const std::string &name, double &tangent, const std::string &documentation);

  const std::vector<Entry> &entries() const { return entries_; }
  const Entry *find(const std::string &path) const;
  /// Hand a value that its pattern matches to the ParameterHandler.
  void set(const std::string &path, const std::string &value);

private:
  void declare(const std::string &name,
               const std::string &default_value,
               const dealii::Patterns::PatternBase &pattern,
               const std::string &documentation,
               const std::function<void(const std::string &)> &action);

  dealii::ParameterHandler &prm_;
  std::vector<std::string> sections_;
  std::vector<Entry> entries_;
};

/// What a value may be, in words: "a number > 0", "grains or continuum", "true or false".
std::string range_in_words(const Declarations::Entry &entry);
/// "[m]" of the documentation, or nothing.
std::string unit_of(const Declarations::Entry &entry);

/// A section of the deck and when it is read.
struct Section
{
  std::string name;
  std::string read_when; ///< in words, for people
};
/// All sections in the order in which they are printed.
const std::vector<Section> &all_sections();
/// Does this scene read the section? Components and the two representations decide.
bool is_read(const std::string &section, const Parameters &parameters);
const std::vector<std::string> &all_components();

/// Declare the entries above all sections and those of the @p sections.
void declare_parameters(Parameters &parameters,
                        const std::vector<std::string> &sections,
                        Declarations &declarations);

// The entries of sections with a file of their own.
/// Strengths of a flat joint: those of the layer and of the matrix' grains.
void declare_strengths(double &tensile_strength,
                       double &cohesion,
                       double &tan_friction,
                       double &residual_friction,
                       Declarations &entries);
void declare(LayerParameters &layer, Declarations &entries);
/// Of finite elements in layer and matrix; @p bare: there is no matrix.
void declare_mesh(MatrixParameters &matrix, bool bare, Declarations &entries);
void declare(const std::string &section,
             MaterialParameters &material,
             Declarations &entries);
void declare(FoundationParameters &foundation, Declarations &entries);
void declare(AbsorbingBoundaryParameters &boundary, Declarations &entries);
void declare(FracturesParameters &fractures, Declarations &entries);
void declare(MeasurementCirclesParameters &circles, Declarations &entries);
void declare(CalibrationParameters &calibration, Declarations &entries);
void declare(StudyParameters &study, Declarations &entries);

/// A value that may stand alone but not in this scene.
struct Finding
{
  std::vector<std::string> entries; ///< paths that it is about, the one to name first
  std::string text;                 ///< what is wrong and what to do
};
/// Everything that is wrong between the values of a scene.
std::vector<Finding> check_parameters(const Parameters &parameters);
/// A number as a message shows it, to four digits.
std::string short_text(double number);
/// The part of it that packings and measurement circles add. \pre nothing else is wrong
void check_packing(const Parameters &parameters, std::vector<Finding> &findings);
void check_circles(const Parameters &parameters, std::vector<Finding> &findings);
/// The parts of it that finite elements and the buckling driver add.
void check_materials(const Parameters &parameters, std::vector<Finding> &findings);
void check_buckling(const Parameters &parameters, std::vector<Finding> &findings);
void check_solid_scene(const Parameters &parameters, std::vector<Finding> &findings);
void check_membrane_of_mesh(const Parameters &parameters, std::vector<Finding> &findings);
/// The part of it that the join of grains and mesh adds.
void check_join(const Parameters &parameters, std::vector<Finding> &findings);
/// The part of it that the event driver adds.
void check_event_driver(const Parameters &parameters, std::vector<Finding> &findings);
/// The part of it that walls that turn add.
void check_turning_walls(const Parameters &parameters, std::vector<Finding> &findings);
/// The part of it that a calibration adds.
void check_calibration(const Parameters &parameters, std::vector<Finding> &findings);
} // namespace antiform::cases
