#include "runner/campaign/campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "contract/errors.h"
#include "contract/named_files.h"
#include "contract/scene_script.h"
#include "runner/campaign/campaign_file.h"
#include "runner/campaign/sweep.h"

namespace peclet::runner {
namespace {

// With a smaller minimum and several stop tests, intervals hold the mean in less than 94 % of the cases
// (results/coverage).
constexpr int smallest_minimum = 8;

// A name is used in headings and names of files.
constexpr std::size_t longest_name = 100;

std::vector<Criterion> also_of(const Json& target, const std::string& leading, const std::string& file) {
  std::vector<Criterion> also;
  if (!target.contains("also")) return also;
  for (const Json& written : target["also"]) {
    const std::string pointer = fmt::format("/target/also/{}", also.size());
    Criterion criterion{written.at("observable").get<std::string>(), tolerance_of(written)};
    const auto is_it = [&](const Criterion& other) { return other.observable == criterion.observable; };
    if (criterion.observable == leading || std::any_of(also.begin(), also.end(), is_it)) {
      throw InputError(file, pointer + "/observable", criterion.observable,
                       "must differ from the observables before it");
    }
    also.push_back(std::move(criterion));
  }
  return also;
}

// Returns the target of a campaign with a fixed number of realisations: the observables that it shows.
Target shown(const Json& document, const std::string& file) {
  if (document.contains("target")) {
    throw InputError(file, "/target", shortened(document["target"]),
                     "must not be given beside a fixed number of realisations; with a target, /realisations "
                     "is { \"minimum\": ..., \"maximum\": ... }");
  }
  const std::vector<std::string> names = document.value("show", std::vector<std::string>{usual_observable});
  Target target{names.front(), Tolerance::none(), usual_confidence};
  for (std::size_t place = 1; place < names.size(); ++place) {
    if (std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(place), names[place]) !=
        names.begin() + static_cast<std::ptrdiff_t>(place)) {
      throw InputError(file, fmt::format("/show/{}", place), names[place],
                       "must differ from the observables before it");
    }
    target.also.push_back({names[place], Tolerance::none()});
  }
  return target;
}

Target aimed_at(const Json& document, const std::string& file) {
  if (!document.contains("target")) {
    throw InputError(file, "/target", "missing",
                     "must be an object, unless /realisations is the number of seeds of every point");
  }
  if (document.contains("show")) {
    throw InputError(
        file, "/show", shortened(document["show"]),
        "must not be given beside a target, whose observables are shown; /target/also adds others");
  }
  const Json& target = document["target"];
  return target_of(target["observable"].get<std::string>(), target, target["confidence"].get<double>(), file);
}

// Returns the number of first seeds of each point whose files are kept.
int seeds_with_files(const Json& document) {
  const Json rule = document.value("keep_files", Json("all"));
  return rule == "all" ? most_realisations : rule == "none" ? 0 : rule.get<int>();
}

// Puts the scene of a file in the place of its name, which starts at the campaign's folder. Throws InputError
// that names the file at fault.
void read_scene(Json& scene, const std::string& file) {
  if (!scene.is_string()) return;
  const auto path = home_of(file) / scene.get<std::string>();
  std::error_code impossible;  // reading it says why
  if (std::filesystem::exists(path, impossible) && !std::filesystem::is_regular_file(path, impossible))
    throw InputError(file, "/scene", shortened(scene), "must name a file; this is none");
  Json read;
  try {
    read = read_json_input(path);
  } catch (const InputError& error) {
    throw InputError(file, "/scene", shortened(scene), error.what());
  }
  if (!read.is_object()) {
    throw InputError(file, "/scene", shortened(scene),
                     fmt::format("must name a file with a scene, an object; it has {}", shortened(read)));
  }
  scene = std::move(read);
}

// Throws InputError if the sweep sets the name of the script, whose text is added to the scene once.
void refuse_swept_script(const std::vector<SweepEntry>& sweep, const std::string& file) {
  for (std::size_t entry = 0; entry < sweep.size(); ++entry) {
    for (const std::string& pointer : sweep[entry].pointers) {
      if (pointer != "/measure" && !pointer.starts_with("/measure/")) continue;
      throw InputError(file, fmt::format("/sweep/{}/set", entry), pointer,
                       "must not be swept: one script measures all points, and may look at frame.scene");
    }
  }
}

// Throws InputError if the file is a scene without a campaign, a common first mistake, and says what to add.
void refuse_bare_scene(const Json& written, const std::string& file) {
  if (!written.is_object() || written.contains("scene") || !written.contains("particles")) return;
  throw InputError(
      file, "", "",
      "is a scene, but must be a campaign: { \"name\": ..., \"scene\": this, \"target\": { "
      "\"relative_tolerance\": 0.05 }, \"realisations\": { \"minimum\": 10, \"maximum\": 200 } }; "
      "`peclet init NEW.json` writes an example, and `peclet-engine run` runs a scene once");
}

}  // namespace

std::vector<Criterion> Target::criteria() const {
  std::vector<Criterion> all{{observable, tolerance}};
  all.insert(all.end(), also.begin(), also.end());
  return all;
}

std::vector<std::string> Target::observables() const {
  const std::vector<Criterion> all = criteria();
  std::vector<std::string> names(all.size());
  std::transform(all.begin(), all.end(), names.begin(),
                 [](const Criterion& criterion) { return criterion.observable; });
  for (const Criterion& criterion : all) {
    const std::string& measure = criterion.tolerance.relative_to;
    if (!measure.empty() && std::count(names.begin(), names.end(), measure) == 0) names.push_back(measure);
  }
  return names;
}

std::string Target::over() const {
  for (const Criterion& criterion : criteria()) {
    if (criterion.tolerance.is_of_curve()) return criterion.tolerance.over;
  }
  return "";
}

std::string to_string(const Target& target) { return to_string(target.criteria()); }

std::string to_string(const std::vector<Criterion>& criteria) {
  std::string text;
  for (const Criterion& criterion : criteria) {
    text += (text.empty() ? "" : ", ") + criterion.observable;
    if (criterion.tolerance.kind != Tolerance::Kind::none) text += " to " + to_string(criterion.tolerance);
  }
  return text;
}

std::string pointer_of(const Target& target, const std::string& observable) {
  const std::vector<Criterion> criteria = target.criteria();
  for (const bool as_measure : {false, true}) {
    for (std::size_t place = 0; place < criteria.size(); ++place) {
      const Criterion& criterion = criteria[place];
      if (observable != (as_measure ? criterion.tolerance.relative_to : criterion.observable)) continue;
      if (!target.has_tolerance()) return fmt::format("/show/{}", place);
      return fmt::format("/target/{}{}", place == 0 ? "" : fmt::format("also/{}/", place - 1),
                         as_measure ? "relative_to" : "observable");
    }
  }
  return "/target";
}

Json criterion_json(const Target& target) {
  Json json = to_json(target.tolerance);
  for (const Criterion& criterion : target.also) {
    Json& other = json["also"].emplace_back(to_json(criterion.tolerance));
    other["observable"] = criterion.observable;
  }
  return json;
}

Json to_json(const Target& target) {
  Json json = criterion_json(target);
  json["observable"] = target.observable;
  json["confidence"] = target.confidence;
  return json;
}

Target target_of(const std::string& observable, const Json& criterion, double confidence,
                 const std::string& file) {
  Target target{observable, tolerance_of(criterion), confidence};
  target.also = also_of(criterion, observable, file);
  for (std::size_t place = 0; place < target.also.size(); ++place) {
    const std::string& over = target.also[place].tolerance.over;
    if (!over.empty() && over != target.over()) {
      throw InputError(file, fmt::format("/target/also/{}/curve/over", place), over,
                       "must be that of the other curves, " + target.over());
    }
  }
  return target;
}

std::vector<Curve> curves_of(const Json& document, const Target& target, const std::string& file) {
  if (target.over().empty()) return {};
  std::string pointer = "/target/curve/over";
  if (!target.tolerance.is_of_curve()) {
    const auto found = std::ranges::find_if(
        target.also, [](const Criterion& criterion) { return criterion.tolerance.is_of_curve(); });
    pointer = fmt::format("/target/also/{}/curve/over", found - target.also.begin());
  }
  const auto curves_along = [&](const Json& sweep) {
    return curves_over(target.over(), document.at("scene"), read_sweep(sweep, file), file, pointer);
  };
  std::vector<Curve> curves = curves_along(document.at("sweep"));  // numbers, to which values can be added
  return chosen_values(document).empty() ? curves : curves_along(whole_sweep(document, target));
}

Json chosen_values(const Json& document) {
  return document.contains("choose") ? document["choose"].value("values", Json::array()) : Json::array();
}

Json whole_sweep(const Json& document, const Target& target) {
  Json sweep = document.at("sweep");
  for (const Json& value : chosen_values(document))
    sweep = with_value_along(std::move(sweep), target.over(), value.get<double>());
  return sweep;
}

Json with_chosen_value(Json document, double value) {
  document.at("choose")["values"].push_back(value);
  return document;
}

Json keeping_chosen_values(Json document, const Json& before) {
  const auto over = [](const Json& campaign) {
    const Json& target = campaign.at("target");
    return target_of("", target, usual_confidence).over();
  };
  const auto is_alike = [&](const char* key) {
    return document.value(key, Json()) == before.value(key, Json());
  };
  const Json known = chosen_values(before);
  if (!known.empty() && document.contains("choose") && !document["choose"].contains("values") &&
      is_alike("sweep") && is_alike("scene") && over(document) == over(before)) {
    document["choose"]["values"] = known;
  }
  return document;
}

void check_campaign_name(const std::string& name, const std::string& file) {
  constexpr const char* allowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789._-";
  if (name.empty() || name.size() > longest_name || name.find_first_not_of(allowed) != std::string::npos) {
    throw InputError(
        file, "/name", shortened(name),
        fmt::format("must have 1 to {} letters, digits, dots, underscores and hyphens", longest_name));
  }
}

Campaign read_campaign(const std::filesystem::path& path) {
  require_campaign_file(path);
  return parse_campaign(read_json_input(path), path.string());
}

Campaign parse_campaign(const Json& written, const std::string& file) {
  refuse_bare_scene(written, file);
  Campaign campaign;
  campaign.document = campaign_keys().validate(written, file);
  read_scene(campaign.document["scene"], file);
  campaign.document["sweep"] = without_ranges(std::move(campaign.document["sweep"]), file);
  const Json& document = campaign.document;
  campaign.name = document["name"].get<std::string>();
  check_campaign_name(campaign.name, file);

  const Json& realisations = document["realisations"];
  const bool is_fixed = realisations.is_number();
  campaign.target = is_fixed ? shown(document, file) : aimed_at(document, file);
  campaign.minimum_realisations = (is_fixed ? realisations : realisations["minimum"]).get<int>();
  campaign.maximum_realisations = (is_fixed ? realisations : realisations["maximum"]).get<int>();
  if (campaign.maximum_realisations < campaign.minimum_realisations) {
    throw InputError(file, "/realisations/maximum", fmt::format("{}", campaign.maximum_realisations),
                     fmt::format("must be an integer >= minimum, {}", campaign.minimum_realisations));
  }
  if (campaign.minimum_realisations < smallest_minimum &&
      campaign.minimum_realisations != campaign.maximum_realisations) {
    throw InputError(
        file, "/realisations/minimum", fmt::format("{}", campaign.minimum_realisations),
        fmt::format("must be an integer >= {}, or equal to maximum: the spread of fewer seeds is too "
                    "uncertain for a stop test",
                    smallest_minimum));
  }
  campaign.engine = document["engine"].get<std::vector<std::string>>();
  campaign.seeds_with_files = seeds_with_files(document);
  if (document.contains("choose")) {
    if (campaign.target.over().empty()) {
      throw InputError(file, "/choose", shortened(document["choose"]),
                       "needs a curve in the target, for whose axis values are chosen");
    }
    campaign.most_values = document["choose"]["points"].get<int>();
  }
  add_script(campaign.document["scene"], home_of(file), file, "/scene");
  campaign.curves = curves_of(document, campaign.target, file);
  const std::vector<SweepEntry> sweep = read_sweep(whole_sweep(document, campaign.target), file);
  refuse_swept_script(sweep, file);
  campaign.points = sweep_points(document["scene"], sweep, campaign.name, file);
  return campaign;
}

// The table of keys, from which schema/campaign.schema.json and the manual are generated.

namespace {

constexpr std::size_t most_further_targets = 100;

// Rows of a tolerance: {0} is the place of its target, {1} the meaning of relative_to.
constexpr const char* tolerance_rows = R"(
/target{0}/relative_tolerance | number > 0 and < 1 | Largest allowed half-width of the confidence interval over
    |mean|; 0.05 is 5 %.
/target{0}/absolute_tolerance | number > 0 and <= 1e100; instead of relative_tolerance | Largest allowed
    half-width in the observable's own unit; for observables that may be zero.
/target{0}/curve | object; instead of relative_tolerance | A tolerance that the band of a curve through the points
    may meet, too.
/target{0}/curve/over | string | Pointer that the sweep sets to different numbers: the axis of the curve.
/target{0}/curve/relative_tolerance | number > 0 and < 1 | Largest allowed half-width of the curve's band, or of
    the point's own interval, over the mean.
/target{0}/curve/even? | true or false | Whether the observable is even in the axis, as a viscosity in /peclet, so
    that a point at 0 tells about those nearby.
/target{0}/relative_to? | string; if relative_tolerance | {1}
/target{0}/absolute_floor? | number > 0 and <= 1e100; if relative_tolerance | Half-width that is always allowed,
    however small the mean to which relative_tolerance refers.
)";

constexpr const char* campaign_rows = R"(
/name | string | Name of the campaign: at most 100 letters, digits, dots, underscores and hyphens.
/scene | object or string | The scene that all points share, or the name of its file; the engine checks it. This
    name and those in the file start at the campaign's folder.
/sweep | array; default [] | Parameters that differ between the points. Several entries make a grid; the last
    varies fastest.
/sweep/* | object
/sweep/*/set | anything | JSON pointer into the scene, or an array of pointers that are set together.
/sweep/*/values | array of 1 or more or object | The values along this axis; with several pointers, each is an
    array with one value for every pointer. An object is a range of values of one pointer.
/sweep/*/values/from, /sweep/*/values/to | number | First and last value of a range.
/sweep/*/values/points | integer >= 2 and <= 100000 | Number of values. Those between the ends are rounded to six
    digits; whole numbers need a list.
/sweep/*/values/spaced | one of log, linear | log: equal ratios of neighbours; linear: equal differences.
/target? | object | The accuracy at which a point is done. Required, unless the number of realisations is fixed.
/target/observable | string; default "{observable}" | Path of a number in the result's mean.
{target}
/target/also? | array of 0 to {targets} | Further observables; a point is done when all observables meet their
    tolerances.
/target/also/* | object
/target/also/*/observable | string | Path of a number in the result's mean.
{also}
/target/confidence | number > 0.5 and < 1; default {confidence} | Confidence of the two-sided interval:
    Student's t, or Clopper and Pearson's for shares.
/realisations | integer >= 1 and <= {realisations} or object | Range of the number of seeds of a point; a single
    number without a target: the seeds of every point.
/realisations/minimum | integer >= 2 and <= {realisations} | Seeds at the first stop test: 8 or more, because
    the spread of fewer is too uncertain to stop a point; 2 or more if it equals maximum, so that there is only
    one stop test.
/realisations/maximum | integer >= 2 and <= {realisations} | Seeds at the last stop test; a point that has not
    converged then is capped. Not below the minimum.
/choose? | object | Values of the curve's axis that the run adds to the sweep, one after the other, where the band
    between the points is wider than the tolerance.
/choose/points | integer >= {fewest} and <= 1000 | Most values of the axis, those of the sweep included.
/choose/values? | array | Values that runs have chosen. The stored document has them; a file needs none.
/choose/values/* | number
/show? | array of 1 to {shown} | For a fixed number of realisations: paths of the numbers in the result's mean
    that tables show. Charts show the first one. relative_viscosity unless given.
/show/* | string
/keep_files? | integer >= 0 and <= {realisations} or one of all, none | Seeds of each point whose files beside
    the result are kept: all (unless given), none, or a number of first seeds.
/engine | array of 1 or more; default ["peclet-engine","serve"] | Program and arguments. A program without a
    slash is searched for beside peclet, then on PATH, then among peclet's own adapters (lammps_engine.py). A
    relative path starts at the folder of the campaign file, in which the engine runs.
/engine/* | string
)";

}  // namespace

const KeyTable& campaign_keys() {
  using fmt::arg;
  static const KeyTable table(
      "A campaign of peclet",
      fmt::format(campaign_rows, arg("observable", usual_observable), arg("confidence", usual_confidence),
                  arg("realisations", most_realisations), arg("targets", most_further_targets),
                  arg("shown", 1 + most_further_targets), arg("fewest", fewest_of_curve),
                  arg("target", fmt::format(tolerance_rows, "",
                                            "Path of another number in the result's mean; "
                                            "relative_tolerance is then a share of its |mean|.")),
                  arg("also", fmt::format(tolerance_rows, "/also/*", "As for the target."))));
  return table;
}

}  // namespace peclet::runner
