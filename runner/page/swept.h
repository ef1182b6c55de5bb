// The swept parameters of a campaign, as the axis and the curves of a figure.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "contract/json.h"
#include "runner/page/page_data.h"

namespace peclet::runner {

// One parameter: its value at each point, as a number or as a word.
struct Swept {
  std::string pointer;  // "" for the points themselves, if nothing is swept
  std::string name;     // its symbol, or the last step of the pointer
  bool numeric = false;
  std::vector<double> numbers{};      // one for each point; for words their places in `values`
  std::vector<std::string> words{};   // one for each point, as shown
  std::vector<std::string> values{};  // each word once, in the order of the points

  std::size_t distinct() const { return values.size(); }
};

// The points of a campaign with their measured numbers and their swept parameters.
struct MeasuredSweep {
  CampaignStatus status;
  PagePoints page;           // with the points of `status` in the same order
  Json parameters;           // page_parameters()
  std::vector<Swept> swept;  // one for each parameter; the labels of the points if nothing is swept
};

// One of several campaigns that are shown together. Their names differ.
struct NamedCampaign {
  Database& database;
  std::string name;
};

// Returns the name of a campaign as a parameter, "campaign", by which points of several are told apart.
Json campaign_parameter();
// Returns the value of a parameter in a scene; null if it is no key of the scene, or absent.
Json value_in(const Json& scene, const std::string& pointer);

// Returns the parameters with their values at the points; the labels of the points if there is none.
std::vector<Swept> swept_columns(const Json& parameters, const Json& points);

// Reads the points that have one of the values that `where` gives for each parameter, as NAME=VALUE; all
// points if it is empty. Throws InputError at --where; throws IntegrityError.
MeasuredSweep read_sweep(Database& database, const std::vector<std::string>& where = {});

// Removes the other points.
void keep_points(MeasuredSweep& sweep, const std::function<bool(const Json& point)>& is_kept);

// True if `name` is the pointer of the parameter, with or without its first slash, or the last step of it.
bool is_called(const Swept& one, const std::string& name);

// Returns the name of a drawable for --quantity: "pressure", "stress/total/xy".
std::string name_of(const Drawable& one);

// Returns the place of the drawable with this name, or with this path. Throws InputError at `--quantity` with
// the names of the measured quantities, and of `others`.
std::size_t chosen_column(const std::vector<Drawable>& drawables, const std::string& name,
                          const std::vector<std::string>& others = {});

// Returns the parameter called `name`: its pointer, or the last step of it if no other parameter has that.
// Without a name returns the one with the most values, numeric ones first. Throws InputError at --over.
const Swept& chosen_axis(const std::vector<Swept>& swept, const std::string& name);

// Returns the parameters that distinguish curves: they vary, and do not follow from the value on the axis.
std::vector<const Swept*> curves_by(const std::vector<Swept>& swept, const Swept& axis);

}  // namespace peclet::runner
