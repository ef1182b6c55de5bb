#include "runner/page/supplement.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "contract/errors.h"
#include "contract/provenance.h"
#include "contract/sha256.h"
#include "runner/campaign/number_text.h"
#include "runner/campaign/quoting.h"
#include "runner/page/figure.h"
#include "runner/page/page_html.h"
#include "runner/reports/export.h"
#include "runner/reports/status.h"

namespace peclet::runner {
namespace {

std::string readme(const CampaignStatus& status) {
  const CampaignRecord& campaign = status.campaign;
  const std::string file = shell_word(campaign.name + ".json");
  const std::string confidence = percent(campaign.target.target.confidence);
  return fmt::format(R"(# {0}

A campaign of peclet {1}: averages over independent realisations, each with its {2} confidence interval.

```
{3}```

| file | what it is |
|---|---|
| `{0}.json` | the campaign: scene, sweep, target |
| `results.csv` | a row for each point: the estimate that decides, and the mean of every scalar |
| `numbers.csv` | a row for each point, quantity and element, also of profiles and distributions, with units |
| `results.json` | all of these numbers, and every realisation |
| `report.html` | a page for a browser: any quantity over any swept parameter, convergence of each mean |
| `figure.py` | a matplotlib script that draws the target over the sweep: `python3 figure.py figure.pdf` |
| `provenance.json` | engines, versions, times |
| `SHA256SUMS` | the checksums of these files: `sha256sum --check SHA256SUMS` |

## Which number

`mean` and `half_width` in `results.csv` are those by which the campaign stopped, with the control variate if
there is one. The table above, the page, the figure and `points/*/stop_test` in `results.json` have the same
two numbers. Means in `numbers.csv` and `points/*/quantities` are over the same seeds, and their half-widths
have the same confidence level.

## Make it again

```
peclet run {4}
peclet export {4} --canonical | cmp - results.json
peclet export {4} --csv --canonical | cmp - results.csv
peclet plot {4} --output figure.py
```

The engines of `provenance.json` give the same bytes. Those of another version, compiler or instruction set
may differ from the last digit on, and agree within the errors.
)",
                     campaign.name, version(), confidence, status_table(status), file);
}

// Returns the time when a seed last ended; before the first one, when the campaign file was last taken over.
std::string last_change(Database& database, const CampaignRecord& campaign) {
  const std::string last_end = database.last_end();
  return last_end.empty() ? campaign.updated_at : last_end;
}

Json provenance_json(Database& database, const CampaignRecord& campaign) {
  Json engines = Json::array();
  for (const EngineRecord& engine : database.engines()) {
    engines.push_back({{"identity", engine.identity}, {"provenance", engine.provenance}});
  }
  const Json& own = provenance();
  return {{"schema_version", 1},
          {"campaign", campaign.name},
          {"campaign_sha256", sha256(canonical_json(campaign.document))},
          {"made_by",
           {{"program", "peclet"},
            {"version", version()},
            {"git_commit", own.value("git_commit", Json())},
            {"git_dirty", own.value("git_dirty", Json())}}},
          {"engines", engines},
          {"machines", database.hosts()},
          {"begun_at", campaign.created_at},
          {"taken_up_at", campaign.updated_at},
          {"last_change_at", last_change(database, campaign)}};
}

std::string sums(const std::vector<ArchivedFile>& files) {
  std::string text;
  for (const ArchivedFile& file : files) text += fmt::format("{}  {}\n", sha256(file.bytes), file.name);
  return text;
}

// Returns the data of the target's figure. Throws InputError at --bundle if the figure can show no point.
Json figure_of(Database& database) try { return figure_data(database, {}); } catch (const InputError& error) {
  throw InputError("", "--bundle", error.value(), error.allowed());
}

std::vector<ArchivedFile> files_of(Database& database, std::optional<std::int64_t> owner) {
  const CampaignStatus status = read_status(database);
  const CampaignRecord& campaign = status.campaign;
  const auto has_number = [](const PointSummary& point) { return point.all_seeds.count > 0; };
  if (std::none_of(status.points.begin(), status.points.end(), has_number)) {
    throw InputError(
        "", "--bundle", campaign.name,
        fmt::format(
            "has no number of {} yet, so that there is nothing to give to readers; `peclet explain` says why",
            campaign.target.target.observable));
  }
  const std::string script = figure_script(figure_of(database));
  std::vector<ArchivedFile> files{{"README.md", readme(status)},
                                  {campaign.name + ".json", campaign.document.dump(2) + '\n'},
                                  {"results.csv", export_csv(database, true)},
                                  {"numbers.csv", export_long_csv(database)},
                                  {"results.json", export_json(database, true)},
                                  {"report.html", report_html(database, owner)},
                                  {"figure.py", script, true},
                                  {"provenance.json", provenance_json(database, campaign).dump(2) + '\n'}};
  files.push_back({"SHA256SUMS", sums(files)});
  return files;
}

}  // namespace

void check_supplement_name(const std::filesystem::path& output) {
  const std::string name = output.filename().string();
  if (name.ends_with(".tar.gz") || name.ends_with(".tgz")) return;
  throw InputError("", "--bundle", output.string(), "must end in .tar.gz or .tgz");
}

std::string supplement(Database& database, std::optional<std::int64_t> owner) {
  const std::vector<ArchivedFile> files = files_of(database, owner);
  const CampaignRecord campaign = database.campaign();
  return gzip(tar(campaign.name, files, seconds_of_utc(last_change(database, campaign))));
}

namespace {

constexpr std::size_t block = 512;

// Returns a header of the format ustar: fields at fixed places, numbers in octal digits.
std::string header(const std::string& folder, const ArchivedFile& file, std::int64_t time) {
  std::string bytes(block, '\0');
  const auto put = [&](std::size_t at, std::size_t room, const std::string& text) {
    if (text.size() > room) throw std::length_error(text + ": too long for an archive");
    bytes.replace(at, text.size(), text);
  };
  // Writes as many digits as there is room for, and a zero byte.
  const auto put_octal = [&](std::size_t at, std::size_t room, std::uint64_t number) {
    const std::string digits = fmt::format("{:0{}o}", number, room - 1);
    if (digits.size() >= room)
      throw std::length_error("a file of more than 8 GiB is too long for an archive");
    put(at, room, digits);
  };
  put(0, 100, file.name);
  put_octal(100, 8, file.executable ? 0755 : 0644);
  put_octal(108, 8, 0);  // user and group are those of the user who unpacks
  put_octal(116, 8, 0);
  put_octal(124, 12, file.bytes.size());
  put_octal(136, 12, static_cast<std::uint64_t>(std::max<std::int64_t>(0, time)));
  put(148, 8, "        ");  // the sum counts its own place as blanks
  put(156, 1, "0");         // a regular file
  put(257, 5, "ustar");
  put(263, 2, "00");
  put(345, 155, folder);  // stands before the name, with a slash
  std::uint64_t sum = 0;
  for (const char c : bytes) sum += static_cast<unsigned char>(c);
  put(148, 8, fmt::format("{:06o}", sum) + std::string("\0 ", 2));
  return bytes;
}

class Deflation {
 public:
  Deflation() {
    constexpr int gzip_format = 16;
    if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, MAX_WBITS + gzip_format, MAX_MEM_LEVEL,
                     Z_DEFAULT_STRATEGY) != Z_OK) {
      throw std::runtime_error("zlib cannot be initialised");
    }
  }
  ~Deflation() { deflateEnd(&stream); }
  Deflation(const Deflation&) = delete;
  Deflation& operator=(const Deflation&) = delete;

  z_stream stream{};
};

}  // namespace

std::string tar(const std::string& folder, const std::vector<ArchivedFile>& files, std::int64_t time) {
  std::string archive;
  for (const ArchivedFile& file : files) {
    archive += header(folder, file, time) + file.bytes;
    archive.resize((archive.size() + block - 1) / block * block, '\0');
  }
  // Two empty blocks end the archive, which is padded to a multiple of twenty blocks as tar does.
  constexpr std::size_t record = 20 * block;
  archive.resize((archive.size() + 2 * block + record - 1) / record * record, '\0');
  return archive;
}

std::string gzip(std::string_view bytes) {
  Deflation deflation;
  z_stream& stream = deflation.stream;
  gz_header about{};
  about.os = 3;  // Unix, wherever zlib was built
  if (deflateSetHeader(&stream, &about) != Z_OK) throw std::runtime_error("zlib cannot set the header");
  std::string packed;
  std::string chunk(1U << 16U, '\0');
  constexpr std::size_t most = std::numeric_limits<uInt>::max() / 2;
  int state = Z_OK;
  while (state != Z_STREAM_END) {
    const std::string_view part = bytes.substr(0, most);
    // zlib only reads the input, although its pointer is not const.
    stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(part.data()));
    stream.avail_in = static_cast<uInt>(part.size());
    bytes.remove_prefix(part.size());
    do {
      stream.next_out = reinterpret_cast<Bytef*>(chunk.data());
      stream.avail_out = static_cast<uInt>(chunk.size());
      state = deflate(&stream, bytes.empty() ? Z_FINISH : Z_NO_FLUSH);
      if (state == Z_STREAM_ERROR) throw std::runtime_error("zlib cannot compress");
      packed.append(chunk, 0, chunk.size() - stream.avail_out);
    } while (stream.avail_out == 0);
  }
  return packed;
}

}  // namespace peclet::runner
