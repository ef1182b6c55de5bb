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
/ending/cause | word | completed and jammed (at a given stress) have means. Any other word is the engine's
    reason for having none; of peclet-engine: overlap, displacement, non-finite, packing, timestep,
    script.
/ending/step | count | The last step.
/ending/message? | string
/ending/state? | string or null | File with the last state of a realisation that broke off.
/method? | one of explicit, implicit or null | Method of integration; null if the engine does not know it.
/timestep? | number or null
/steps? | object | Steps taken.
/steps/* | count
/strain? | object | Strain reached; null without flow.
/time? | object | Time simulated; null if the engine has no time.
/derived? | object | Dimensionless groups and time scales of the scene; null where one is not defined.
/strain/*, /time/*, /derived/* | number or null
/warnings? | array
/warnings/* | object
/warnings/*/code | word
/warnings/*/message | string
/units? | one of viscosity * shear_rate, scene | Unit of stresses; scene: the scene's own units, used if the
    shear rate is zero.
/mean | object or null | Means over the production window: numbers, null, and lists and objects of these.
    Names have 1 to 120 bytes without control characters. Every number and every element of a list of numbers
    may be a campaign's target. Null after an ending without results.
/blocks | object or null | Block means of the numbers of mean, at the same paths, in five digits; null for a
    block without a sample. A scalar has 32 means over consecutive parts of the window (moduli 4 to 32). A
    list of up to 64 numbers has the means of the four quarters. A longer list and a function of lags have no
    blocks. shear_stress holds, by term, the 32 means of the xy component of every stress that fluctuates.
    Null if mean is null.
/quantities? | object or null | Descriptions of the numbers of mean, by their paths in it: "stress/total"
    describes /mean/stress/total. If absent or {{}}, the runner takes every number and every list of numbers
    in mean as a quantity without a unit. Null after an ending without results.
/quantities/* | object
/quantities/*/symbol | name or empty
/quantities/*/unit | name | "1": a pure number.
/quantities/*/estimator | one of mean, ratio, share | mean: the average of the values over the seeds. share:
    the average of a number that is 0 or 1, without axes and control. ratio: the average numerator divided by
    the average denominator.
/quantities/*/axes? | array; if estimator mean, ratio | Axes of an array; absent for a scalar. Values are
    nested lists, the first axis outermost.
/quantities/*/axes/* | object
/quantities/*/axes/*/name, /quantities/*/axes/*/unit | name
/quantities/*/axes/*/values | array of 1 or more
/quantities/*/axes/*/values/* | number or name
/quantities/*/numerator, /quantities/*/denominator | name; if estimator ratio | Member of the quantity's
    object in mean.
/quantities/*/control? | object; if estimator mean | Control variate: another quantity of the same shape and
    of known mean. value + control - mean has the mean of the value.
/quantities/*/control/quantity | string
/quantities/*/control/mean | number
/inefficiencies? | object or null | Statistical inefficiencies [blocks] of scalar quantities with blocks, by
    name, without control variate: 1 + 2 times the sum of the autocorrelation of the block means up to its
    first value that is not positive.
/inefficiencies/* | number >= 1
/statistical_inefficiency? | number or null | Statistical inefficiency of the observable in the window
    [blocks]; 1 for independent blocks.
/largest_overlap? | number or null | Largest overlap of any pair at any step, in units of the smaller radius.
/files? | array of 0 to {1} | Files beside this result, on disk before it; absent without files.
/files/* | object
/files/*/name | string | 1 to 64 letters, digits, dots, underscores and hyphens. The first is a letter or
    digit. Not two dots in a row, not ending in .tmp, and different for each file.
/files/*/bytes | integer >= 0 and <= {2}
/files/*/sha256 | hash
/gate? | object or null | Errors of the finite step; null if the spheres could not be packed.
/gate/largest_stability_share? | number >= 0 | Largest share of the method's range of stable steps that the
    step used, over all checks; unstable from 1 on.
/gate/energy_imbalance? | number or null | Energy error of the finite step over the work of the flow; null
    without steady flow and with noise.
/gate/half_step_difference? | number or null | Pair stress with whole steps over the one with half steps, less
    1, on samples; null without steady flow, with noise and in windows below 10000 explicit or 100 implicit
    steps.
/gate/solver? | object or null | Accuracy of the solver of implicit steps; null with explicit steps.
/gate/solver/iterations_per_step | number >= 0 | Mean number of conjugate-gradient iterations in the
    production window.
/gate/solver/mean_residual | number >= 0 | Residual of the equations of a step, relative to the motion, in the
    energy norm; mean over the production window.
/gate/solver/largest_residual | number >= 0 | The largest residual of a step in the production window.
/gate/solver/divided_steps | count | Steps of the production window that were divided, because spheres would
    have moved too far or the solver did not converge.
/gate/solver/deepest_division | count | The smallest part of a divided step was 2^-deepest_division of a step.
/cost | object | The only block that differs between repetitions of a realisation.
/cost/cpu_seconds, /cost/wall_seconds | number >= 0
/final_state_sha256 | hash or null | Null only after an ending without results.
/engine | object | Provenance of the engine. version, binary_sha256 and instruction_set are its identity.
/engine/version, /engine/instruction_set | name
/engine/binary_sha256 | hash | Hash of everything that can change a result.
/engine/git_commit?, /engine/compiler?, /engine/flags?, /engine/build_type?, /engine/cpu?, /engine/device? | string
/engine/git_dirty? | true or false or null
)";

// {job} is the row of the attempt's number, {request} the row of the number or text of a question.
constexpr const char* frame_rows = R"(
-- hello | Engine: sent once, before any other message.
/protocol | integer = 1
/program? | string
/engine | object | Provenance of the engine, as in the result.
/capacity | integer >= 1 and <= 100000; default 1 | Number of jobs that the engine runs at once.
/ahead | true or false; default false | The engine accepts one job more than it runs, and begins it when one
    has ended.
/scene_schema? | object | JSON Schema of its scenes, with title, symbol and unit of keys.
/derived? | array | Descriptions of the derived numbers of validated, in the order in which they are shown.
/derived/* | object
/derived/*/name | name
/derived/*/words, /derived/*/symbol, /derived/*/unit | name or empty; default ""

-- validated | Engine: the scene can be run.
{request}
/timestep | number >= 0 and <= {largest} or null | Time step; null if the engine has no time step.
/timestep_limit? | string | What keeps the time step from being longer, in a word.
/steps | number >= 0 and <= {largest} | Estimated number of steps of a whole realisation.
/particles | integer >= 0 and <= 2147483647 | Number of particles; 0 if not known.
/derived | object | Dimensionless groups and time scales of the scene, by name.
/derived/* | number or null
/observables? | array | Paths in mean of the numbers that results will have; absent if the engine does not
    know them. * stands for any index of a list: "stress/total/*".
/observables/* | string
/hints? | object | Advice about targets that are not among the observables, by their names. Each is the rest
    of a sentence that begins with the name.
/hints/* | string
/warnings | array
/warnings/* | object
/warnings/*/code? | string
/warnings/*/message | string

-- refused | Engine: the scene cannot be run.
{request}
/pointer | string | JSON pointer inside the scene.
/value, /allowed | string

-- progress | Engine: sent about every progress_seconds. Only a higher step or a later phase renews the lease.
{job}
/phase | one of {phases}
/step | count
/steps | count | Estimated total number of steps; 0 while packing.
/strain | number >= -{largest} and <= {largest}

-- carrying | Engine: files of the job are coming from another machine, which renews the leases of its jobs. At most once
    a second.
{job}

-- lost | Engine: its part on another machine is gone, or the link to it. Its jobs are queued again, without blame unless
    that part sent nonsense.
/message | string
/cause | one of link, nonsense, no-room; default "link"

-- result | Engine: the result is on disk, in the file named spool.
{job}
/spool | string | Path of the result, as in the job.
/sha256 | string | SHA-256 of the file's bytes, in lower-case hexadecimal.

-- failed | Engine: the job could not be run at all.
{job}
/message | string

-- drained | Engine: the checkpoint is on disk and the job is given up.
{job}
/step | count

-- no-room | Engine: a file does not fit onto the disk. The engine keeps its work, tries again, and sends this
    message after each failure.
{job}
/path | string | Absolute path of the file: the checkpoint, the result, or a file in the folder of failures.
/bytes | integer >= 0 and < 68719476736

-- validate | Runner: can this scene be run?
/request | anything | A number or text, which the answer repeats.
/scene | object
/seeds | integer >= 1 and <= {seeds}; default 1 | Bound on the seeds of jobs with this scene: 0 to seeds - 1.

-- job | Runner: run this seed; resume from the checkpoint if there is one. Paths are absolute.
{job}
/point | hash
/seed | integer >= 0 and < {seeds}
/scene | object
/threads | integer >= 1 and <= 1024; default 1
/checkpoint | string | File of the checkpoint.
/spool | string | File for the result.
/checkpoint_seconds | number >= 0 and <= {largest}; default 300
/progress_seconds | number >= 0 and <= {largest}; default 1
/files | string; default "" | Prefix of the paths of files beside the result; a name follows it.
/failures | string; default "" | Folder for the last states of realisations that broke off.

-- drain | Runner: write the checkpoint and answer drained; an idle engine exits.
-- stop | Runner: exit at once.
)";

}  // namespace

const KeyTable& result_keys() {
  static const KeyTable table("Result of a realisation, written by an engine",
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
                  arg("job", "/job | count | Number of the attempt, as in the job frame."),
                  arg("request", "/request? | anything | The number or text of the question's request.")),
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
