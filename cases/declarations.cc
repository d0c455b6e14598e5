#include "cases/declarations.h"
#include "cases/deck_reader.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

namespace antiform::cases
{
namespace
{
constexpr double infinity = std::numeric_limits<double>::infinity();
} // namespace

bool parse_number(const std::string &text, double &number)
{
  const std::string trimmed = tidy(text);
  const char *begin = trimmed.data();
  const char *end = begin + trimmed.size();
  if (begin != end && *begin == '+')
    ++begin;
  const auto [stop, error] = std::from_chars(begin, end, number);
  return error == std::errc() && stop == end && std::isfinite(number);
}

std::string exact_text(const double number)
{
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number);
  return std::string(buffer.data(), result.ptr);
}

double tangent_of_degrees(const double degrees)
{
  return std::tan(degrees * M_PI / 180.);
}

double degrees_of_tangent(const double tangent)
{
  const double raw = std::atan(tangent) * 180. / M_PI;
  for (int digits = 1; digits <= 16; ++digits)
  {
    std::ostringstream text;
    text.precision(digits);
    text << raw;
    const double rounded = std::stod(text.str());
    if (tangent_of_degrees(rounded) == tangent)
      return rounded;
  }
  // Rounding in atan may miss the angle that the deck gave by some units of the last
  // place.
  double below = raw, above = raw;
  for (int step = 0; step < 16; ++step)
  {
    for (const double candidate : {below, above})
      if (tangent_of_degrees(candidate) == tangent)
        return candidate;
    below = std::nextafter(below, -infinity);
    above = std::nextafter(above, infinity);
  }
  return raw;
}

// --- Number ------------------------------------------------------------------------

Number Number::any()
{
  return between(-infinity, infinity);
}

Number Number::above(const double lower)
{
  Number range = at_least(lower);
  range.lower_open_ = true;
  return range;
}

Number Number::at_least(const double lower)
{
  return between(lower, infinity);
}

Number Number::between(const double lower, const double upper)
{
  Number range;
  range.lower_ = lower;
  range.upper_ = upper;
  return range;
}

Number Number::below(const double upper) const
{
  Number range = up_to(upper);
  range.upper_open_ = true;
  return range;
}

Number Number::up_to(const double upper) const
{
  Number range = *this;
  range.upper_ = upper;
  return range;
}

Number Number::whole() const
{
  Number range = *this;
  range.whole_ = true;
  return range;
}

bool Number::match(const std::string &text) const
{
  double number = 0.;
  if (!parse_number(text, number))
    return false;
  // A whole number must fit the int that it is bound to.
  if (whole_ && (number != std::floor(number) ||
                 std::abs(number) > std::numeric_limits<int>::max()))
    return false;
  return (lower_open_ ? number > lower_ : number >= lower_) &&
         (upper_open_ ? number < upper_ : number <= upper_);
}

std::string Number::description(OutputStyle) const
{
  std::string text = whole_ ? "a whole number" : "a number";
  if (lower_ > -infinity)
    text += (lower_open_ ? " > " : " >= ") + exact_text(lower_);
  if (upper_ < infinity)
    text += (lower_ > -infinity ? " and" : "") +
            std::string(upper_open_ ? " < " : " <= ") + exact_text(upper_);
  return text;
}

std::unique_ptr<dealii::Patterns::PatternBase> Number::clone() const
{
  return std::make_unique<Number>(*this);
}

// --- NumberList --------------------------------------------------------------------

std::vector<std::string> NumberList::split(const std::string &text)
{
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');)
    parts.push_back(tidy(part));
  return parts;
}

bool NumberList::match(const std::string &text) const
{
  const std::vector<std::string> parts = split(text);
  return std::all_of(parts.begin(), parts.end(),
                     [this](const std::string &part) { return range_.match(part); });
}

std::string NumberList::description(OutputStyle) const
{
  // "a number > 0" in the plural
  const std::string one = range_.description();
  return "numbers" + one.substr(one.find("number") + 6) + ", with commas between them";
}

std::unique_ptr<dealii::Patterns::PatternBase> NumberList::clone() const
{
  return std::make_unique<NumberList>(*this);
}

// --- Percentage --------------------------------------------------------------------

bool Percentage::parse(const std::string &text, double &percent)
{
  percent = 0.;
  const std::string trimmed = tidy(text);
  if (trimmed.empty())
    return true;
  return trimmed.back() == '%' &&
         parse_number(trimmed.substr(0, trimmed.size() - 1), percent) && percent > 0. &&
         percent <= 100.;
}

bool Percentage::match(const std::string &text) const
{
  double percent = 0.;
  return parse(text, percent);
}

std::string Percentage::description(OutputStyle) const
{
  return "a percentage > 0 % and <= 100 %, as 5 %, or nothing";
}

std::unique_ptr<dealii::Patterns::PatternBase> Percentage::clone() const
{
  return std::make_unique<Percentage>();
}

// --- Declarations ------------------------------------------------------------------

void Declarations::enter(const std::string &section)
{
  prm_.enter_subsection(section);
  sections_.push_back(section);
}

void Declarations::leave()
{
  prm_.leave_subsection();
  sections_.pop_back();
}

void Declarations::declare(const std::string &name,
                           const std::string &default_value,
                           const dealii::Patterns::PatternBase &pattern,
                           const std::string &documentation,
                           const std::function<void(const std::string &)> &action)
{
  prm_.declare_entry(name, default_value, pattern, documentation);
  prm_.add_action(name, action);
  const std::string path = join(sections_, "/") + (sections_.empty() ? "" : "/") + name;
  entries_.push_back({path, default_value, documentation, pattern.clone()});
}

void Declarations::number(const std::string &name,
                          double &value,
                          const std::string &documentation,
                          const Number &range)
{
  declare(name, exact_text(value), range, documentation,
          [&value](const std::string &text) { parse_number(text, value); });
}

void Declarations::whole(const std::string &name,
                         int &value,
                         const std::string &documentation,
                         const Number &range)
{
  declare(name, std::to_string(value), range.whole(), documentation,
          [&value](const std::string &text)
          {
            double number = 0.;
            parse_number(text, number);
            value = static_cast<int>(number);
          });
}

void Declarations::choice(const std::string &name,
                          std::string &value,
                          const std::string &documentation,
                          const std::string &words)
{
  declare(name, value, dealii::Patterns::Selection(words), documentation,
          [&value](const std::string &text) { value = text; });
}

void Declarations::flag(const std::string &name,
                        bool &value,
                        const std::string &documentation)
{
  declare(name, value ? "true" : "false", dealii::Patterns::Bool(), documentation,
          [&value](const std::string &text) { value = text == "true" || text == "yes"; });
}

void Declarations::text(const std::string &name,
                        std::string &value,
                        const std::string &documentation)
{
  declare(name, value, dealii::Patterns::Anything(), documentation,
          [&value](const std::string &text) { value = text; });
}

void Declarations::list(const std::string &name,
                        std::vector<std::string> &value,
                        const std::string &documentation)
{
  declare(name, join(value), dealii::Patterns::Anything(), documentation,
          [&value](const std::string &text)
          {
            value.clear();
            std::istringstream words(text);
            std::string word;
            while (std::getline(words, word, ','))
              value.push_back(tidy(word));
          });
}

void Declarations::numbers(const std::string &name,
                           std::vector<double> &value,
                           const std::string &documentation,
                           const Number &range)
{
  std::vector<std::string> words;
  for (const double number : value)
    words.push_back(exact_text(number));
  declare(name, join(words), NumberList(range), documentation,
          [&value](const std::string &text)
          {
            value.clear();
            for (const std::string &part : NumberList::split(text))
            {
              value.emplace_back();
              parse_number(part, value.back());
            }
          });
}

void Declarations::percentage(const std::string &name,
                              double &percent,
                              const std::string &documentation)
{
  declare(name, percent > 0. ? exact_text(percent) + " %" : "", Percentage(),
          documentation,
          [&percent](const std::string &text) { Percentage::parse(text, percent); });
}

void Declarations::angle(const std::string &name,
                         double &tangent,
                         const std::string &documentation)
{
  declare(name, exact_text(degrees_of_tangent(tangent)), Number::at_least(0.).below(90.),
          documentation,
          [&tangent](const std::string &text)
          {
            double degrees = 0.;
            parse_number(text, degrees);
            tangent = tangent_of_degrees(degrees);
          });
}

const Declarations::Entry *Declarations::find(const std::string &path) const
{
  const auto entry = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry &e) { return e.path == path; });
  return entry == entries_.end() ? nullptr : &*entry;
}

void Declarations::set(const std::string &path, const std::string &value)
{
  std::vector<std::string> names;
  std::istringstream parts(path);
  for (std::string name; std::getline(parts, name, '/');)
    names.push_back(name);
  for (std::size_t i = 0; i + 1 < names.size(); ++i)
    prm_.enter_subsection(names[i]);
  prm_.set(names.back(), value);
  for (std::size_t i = 0; i + 1 < names.size(); ++i)
    prm_.leave_subsection();
}

std::string range_in_words(const Declarations::Entry &entry)
{
  if (dynamic_cast<const dealii::Patterns::Bool *>(entry.pattern.get()) != nullptr)
    return "true or false";
  if (dynamic_cast<const Number *>(entry.pattern.get()) != nullptr ||
      dynamic_cast<const NumberList *>(entry.pattern.get()) != nullptr ||
      dynamic_cast<const Percentage *>(entry.pattern.get()) != nullptr)
    return entry.pattern->description();
  if (dynamic_cast<const dealii::Patterns::Selection *>(entry.pattern.get()) == nullptr)
    return "a text";
  // "[Selection a|b ]"
  std::string words = entry.pattern->description();
  words = words.substr(11, words.find(']') - 11);
  std::string result;
  for (const char c : tidy(words))
    result += c == '|' ? std::string(" or ") : std::string(1, c);
  return result;
}

std::string unit_of(const Declarations::Entry &entry)
{
  const std::size_t begin = entry.documentation.rfind('[');
  if (begin == std::string::npos)
    return "";
  return entry.documentation.substr(begin,
                                    entry.documentation.find(']', begin) + 1 - begin);
}
} // namespace antiform::cases
