#include "contract/documents.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "contract/errors.h"
#include "contract/frames.h"

namespace peclet {
namespace {

constexpr const char* result_rows = R"(
/schema_version | integer = 1
/point | hash | SHA-256 of the point's canonical scene.
/seed | integer >= 0 and < {0}
/ending | object
/ending/cause | word | completed; jammed under its stress, with means too; or the engine's word for why there
    are no means: peclet-engine has overlap, displacement, non-finite, packing, timestep.
/ending/step | count | The last step.
/ending/message? | string
/ending/state? | string or null | File with the state of a blow-up.
/method? | one of explicit, implicit or null | How the equations of motion were solved; null: not known to the
    engine.
/timestep? | number or null
/steps? | object | Steps taken.
/steps/* | count
/strain? | object | Strain reached; null if there is none.
/time? | object | Time simulated; null if there is none.
/derived? | object | Dimensionless groups and time scales of the scene; null where they have no meaning.
/strain/*, /time/*, /derived/* | number or null
/warnings? | array
/warnings/* | object
/warnings/*/code | word
/warnings/*/message | string
/units? | one of viscosity * shear_rate, scene | Units of stresses: the scene's own if the rate is zero.
/mean | object or null | Means over the production window: numbers, null, and lists and objects of these, by
    names of 1 to 120 bytes without control characters. Every number and every element of a list of numbers
    may be a campaign's target. Null after an ending without results.
/blocks | object or null | Block means of the numbers of mean, at the same paths, in five digits; null in a
    block without a sample. A scalar has 32 means over consecutive parts of the window (moduli 4 to 32), a
    list of up to 64 numbers has those of the four quarters, a longer list and a function of lags have none.
    shear_stress: 32 of xy of every stress that fluctuates, by term. Null when mean is.
/quantities? | object or null | What the numbers of mean are, by their paths in it: "stress/total" is
    /mean/stress/total. If it is absent or {{}}, the runner takes every number and every list of numbers in
    mean for a quantity without a unit. Null after an ending without results.
/quantities/* | object
/quantities/*/symbol | name or empty
/quantities/*/unit | name | "1": a pure number.
/quantities/*/estimator | one of mean, ratio, share | mean: its values are averaged over the seeds. share: the
    same of a number that is 0 or 1, without axes and control. ratio: numerator and denominator are averaged,
    and then divided.
/quantities/*/axes? | array; if estimator mean, ratio | Absent for a scalar. Values are lists within lists,
    the first axis outermost.
/quantities/*/axes/* | object
/quantities/*/axes/*/name, /quantities/*/axes/*/unit | name
/quantities/*/axes/*/values | array of 1 or more
/quantities/*/axes/*/values/* | number or name
/quantities/*/numerator, /quantities/*/denominator | name; if estimator ratio | A member of the object in
    mean.
/quantities/*/control? | object; if estimator mean | Another quantity of the same shape and of known mean:
    value + control - mean has the mean of the value.
/quantities/*/control/quantity | string
/quantities/*/control/mean | number
/inefficiencies? | object or null | Inefficiencies of scalar quantities with blocks, by name: 1 + 2 times the
    sum of the autocorrelation of the block means up to its first value that is not positive (in blocks;
    without control variate).
/inefficiencies/* | number >= 1
/statistical_inefficiency? | number or null | Inefficiency of the observable in the window, in blocks; 1 for
    independent blocks.
/largest_overlap? | number or null | Largest overlap of any pair at any step, over the smaller radius.
/files? | array of 0 to {1} | Files that the realisation has left beside this result, durable before it;
    absent if there are none.
/files/* | object
/files/*/name | string | 1 to 64 letters, digits, dots, underscores and hyphens, the first a letter or digit,
    no two dots in a row, not ending in .tmp; no two are equal.
/files/*/bytes | integer >= 0 and <= {2}
/files/*/sha256 | hash
/gate? | object or null | Errors of the step; null if nothing was packed.
/gate/largest_stability_share? | number >= 0 | Used part of the range of stable steps, at the stiffest packing
    that was checked; from 1 on unstable.
/gate/energy_imbalance? | number or null | Energy that the finite step has made over the work of the flow;
    null without flow and with noise.
/gate/half_step_difference? | number or null | Stress of pairs with steps over that with half steps, on
    samples, less 1; null without flow, with noise and in windows below 10000 explicit or 100 implicit steps.
/gate/solver? | object or null | How well implicit steps solved their equations; null with explicit ones.
/gate/solver/iterations_per_step | number >= 0 | Of conjugate gradients, in the production window.
/gate/solver/mean_residual | number >= 0 | Residual of the equations of a step, relative to the motion, in the
    energy norm; mean of the production window.
/gate/solver/largest_residual | number >= 0 | The largest residual.
/gate/solver/divided_steps | count | Steps of the production window that were made in parts, because spheres
    would have leapt or velocities were not found.
/gate/solver/deepest_division | count | The smallest part of any of them was 2^-deepest_division of a step.
/cost | object | The only block that repetitions do not share.
/cost/cpu_seconds, /cost/wall_seconds | number >= 0
/final_state_sha256 | hash or null | Null only after an ending without results.
/engine | object | Where the program comes from. version, binary_sha256 and instruction_set are its identity.
/engine/version, /engine/instruction_set | name
/engine/binary_sha256 | hash | Hash of all that can change a result.
/engine/git_commit?, /engine/compiler?, /engine/flags?, /engine/build_type?, /engine/cpu? | string
/engine/git_dirty? | true or false or null
)";

// {job} is the row of a job's number, {request} that of a question's echo.
constexpr const char* frame_rows = R"(
-- hello | Engine, once, before anything else.
/protocol | integer = 1
/program? | string
/engine | object | As in the result.
/ahead | true or false; default false | It takes one further job while one runs, and begins it when that has
    ended.
/scene_schema? | object | JSON Schema of its scenes, with title, symbol and unit of keys.
/derived? | array | The numbers of validated, in the order in which people look for them.
/derived/* | object
/derived/*/name | name
/derived/*/words, /derived/*/symbol, /derived/*/unit | name or empty; default ""

-- validated | Engine: the scene can be run.
{request}
/timestep | number >= 0 and <= {largest} or null | null: the engine has none.
/steps | number >= 0 and <= {largest} | Estimate of a whole realisation.
/particles | integer >= 0 and <= 2147483647 | 0: not known.
/derived | object | Numbers by name.
/derived/* | number or null
/observables? | array | If the engine knows them: the numbers that its results will have, as paths in mean; *
    stands for any index of a list: "stress/total/*".
/observables/* | string
/hints? | object | What to do about a target that is none of the observables: by its name, the rest of a
    sentence that begins with it.
/hints/* | string
/warnings | array
/warnings/* | object
/warnings/*/code? | string
/warnings/*/message | string

-- refused | Engine: the scene cannot be run.
{request}
/pointer | string | JSON pointer inside the scene.
/value, /allowed | string

-- progress | Engine, about every progress_seconds. Only a higher step (or a later phase) renews the lease.
{job}
/phase | one of {phases}
/step | count
/steps | count | Estimate of the total; 0 while packing.
/strain | number >= -{largest} and <= {largest}

-- result | Engine: the result is durable in the spool file.
{job}
/spool | string | As in the job.
/sha256 | string | Of the file's bytes, in lower-case hexadecimal.

-- failed | Engine: the job could not be run at all.
{job}
/message | string

-- drained | Engine: the checkpoint is durable and the job is given up.
{job}
/step | count

-- no-room | Engine: a file of this size does not fit onto the disk. The engine keeps its work, tries again,
    and says so each time.
{job}
/path | string | The checkpoint, the spool file, or a file in the folder of failures; absolute.
/bytes | integer >= 0 and < 68719476736

-- validate | Runner: can this scene be run?
/request | anything | A number or text.
/scene | object
/seeds | integer >= 1 and <= {seeds}; default 1 | No more will be asked for: 0 to seeds - 1.

-- job | Runner: run this seed; resume from the checkpoint if there is one. Paths are absolute.
{job}
/point | hash
/seed | integer >= 0 and < {seeds}
/scene | object
/threads | integer >= 1 and <= 1024; default 1
/checkpoint, /spool | string
/checkpoint_seconds | number >= 0 and <= {largest}; default 300
/progress_seconds | number >= 0 and <= {largest}; default 1
/files | string; default "" | What the paths of files beside the result begin with: a name follows.
/failures | string; default "" | Folder for states of blow-ups.

-- drain | Runner: checkpoint, answer drained; an idle engine leaves.
-- stop | Runner: leave at once.
)";

}  // namespace

const KeyTable& result_keys() {
  static const KeyTable table("Result of a realisation, which an engine writes into the spool",
                              fmt::format(result_rows, most_realisations, most_left_files, largest_left_file),
                              Unknown::ignored);
  return table;
}

const KindTables& frame_keys() {
  using fmt::arg;
  static const KindTables tables(
      "Payload of one message between runner and engine, protocol 1", "type",
      fmt::format(frame_rows, arg("largest", largest_number), arg("seeds", most_realisations),
                  arg("phases", fmt::join(job_phases, ", ")),
                  arg("job", "/job | count | The attempt's number, as the job frame gave it."),
                  arg("request", "/request? | anything | A number or text, the echo of the question's.")),
      Unknown::ignored);
  return tables;
}

Json checked_frame(Json message) {
  try {
    return frame_keys().validate(std::move(message), "");
  } catch (const InputError& error) {
    throw FrameError(fmt::format("wrong message: {}", error.what()));
  }
}

}  // namespace peclet
