#include "runner/command_line/watch.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <optional>
#include <system_error>
#include <vector>

#include "contract/errors.h"
#include "contract/text.h"
#include "runner/campaign/campaign_file.h"
#include "runner/campaign/text_table.h"
#include "runner/engines/engine_process.h"
#include "runner/owner/open_campaign.h"
#include "runner/page/live_campaign.h"
#include "runner/page/loopback_server.h"
#include "runner/reports/status.h"
#include "runner/store/database.h"
#include "runner/store/locks.h"

namespace peclet::runner {
namespace {

struct Size {
  int rows = 24, columns = 80;
};

// Returns the present size of the terminal, which may change; 24 x 80 if it is unknown.
Size terminal_size() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_row == 0 || size.ws_col == 0) return {};
  return {size.ws_row, size.ws_col};
}

// Turns off the echo of the terminal, so that typed keys do not appear within the table. Reads nothing.
class SilentKeys {
 public:
  SilentKeys() : is_ours_(tcgetpgrp(STDIN_FILENO) == getpgrp() && tcgetattr(STDIN_FILENO, &before_) == 0) {
    if (!is_ours_) return;
    termios silent = before_;
    silent.c_lflag &= ~static_cast<tcflag_t>(ECHO);
    tcsetattr(STDIN_FILENO, TCSANOW, &silent);
  }
  ~SilentKeys() {
    if (is_ours_)
      tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_);  // drops the keys, so that no shell reads them
  }
  SilentKeys(const SilentKeys&) = delete;
  SilentKeys& operator=(const SilentKeys&) = delete;

 private:
  termios before_{};
  bool is_ours_;
};

struct Sight {
  std::string text;
  int exit_code = 0;
  std::string curve{};  // shown if there is room for it
};

bool is_continuation(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

std::string fitted_line(std::string_view line, int columns) {
  int characters = 0;
  std::size_t end = 0, last_start = 0;
  for (; end < line.size(); ++end) {
    if (is_continuation(line[end])) continue;
    if (characters == columns) return std::string(line.substr(0, last_start)) + "…";
    last_start = end;
    ++characters;
  }
  return std::string(line);
}

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) lines.push_back(take_line(text));
  return lines;
}

// Reads the status. Opens the database anew each time, because an open reader would keep the owner's
// write-ahead log from being reset. Throws InputError for a faulty campaign, which `run` would refuse.
Sight sight_of(const WatchOptions& options, std::size_t width) {
  const auto waits = [&](const std::string& text) -> Sight {
    return {folded(text + '\n', width), ExitCode::unfinished};
  };
  if (awaits_its_first_run(options.campaign, options.directory)) {
    return waits(fmt::format("{}: nothing has been run yet; waiting for `peclet run {}`",
                             read_new_campaign(options.campaign, options.directory).name,
                             words_for(options.campaign, options.directory)));
  }
  try {
    OpenCampaign open = open_campaign(options.campaign, options.directory);
    const CampaignStatus status = read_status(open.database, current_owner(open.directory));
    return {status_table(status, width) + workers_text(status, width), exit_code_of(status),
            curve_text(status, width)};
  } catch (const BeingSetUp& error) {
    return waits(error.what());
  }
}

// Returns the table, followed by the curve if both fit the terminal.
std::string with_curve(const Sight& sight, const Size& size) {
  const std::size_t needed = lines_of(sight.text).size() + 1 + lines_of(sight.curve).size();
  const bool fits = !sight.curve.empty() && needed < static_cast<std::size_t>(size.rows);
  return fits ? sight.text + '\n' + sight.curve : sight.text;
}

void show(const std::string& text, const Size& size) {
  // Goes to the top, writes each line and erases its rest, then erases everything below. This avoids flicker.
  std::string screen = "\x1b[H";
  const std::string visible = fitted(text, size.rows - 1, size.columns);
  for (const std::string_view line : lines_of(visible)) screen += std::string(line) + "\x1b[K\n";
  std::fputs((screen + "\x1b[J").c_str(), stdout);
  std::fflush(stdout);
}

}  // namespace

std::string fitted(std::string_view text, int rows, int columns) {
  std::vector<std::string_view> lines = lines_of(text);
  const auto most = static_cast<std::size_t>(std::max(rows, 1));
  std::string more;
  if (lines.size() > most) {
    more = fmt::format("and {} more lines: `peclet status` has them", lines.size() - most + 1);
    lines.resize(most - 1);
    lines.push_back(more);
  }
  std::string shown;
  for (const std::string_view line : lines) shown += fitted_line(line, std::max(columns, 1)) + '\n';
  return shown;
}

int watch_campaign(const WatchOptions& options) {
  StopSignals signals;
  const bool terminal = isatty(STDOUT_FILENO) != 0;
  std::optional<SilentKeys> silent;
  if (terminal) silent.emplace();
  const std::chrono::milliseconds interval(static_cast<int>(1000 * options.interval_seconds));
  std::string before;
  for (;;) {
    const Size size = terminal_size();
    const std::size_t width = terminal ? static_cast<std::size_t>(size.columns) : unlimited_width;
    const Sight sight = sight_of(options, width);
    if (terminal) {
      show(with_curve(sight, size), size);
    } else if (sight.text != before) {
      fmt::print("{}{}", before.empty() ? "" : "\n", sight.text);
      std::fflush(stdout);
      before = sight.text;
    }
    if (sight.exit_code != ExitCode::unfinished || signals.wait(interval)) return sight.exit_code;
  }
}

int serve_campaign(const ServeOptions& options) {
  StopSignals signals;
  LiveCampaign campaign(options.campaign, options.directory);
  LoopbackServer server(options.port);
  fmt::print("http://127.0.0.1:{}/\n", server.port());
  if (std::fflush(stdout) != 0) throw std::system_error(errno, std::generic_category(), "standard output");
  fmt::print(stderr,
             "peclet: serving the page of {}; Ctrl-C ends the server and does not affect the campaign\n",
             printable(campaign.name()));
  server.serve(signals.descriptor(), [&](const HttpRequest& request) { return answer(campaign, request); });
  campaign.refresh();
  return campaign.exit_code();
}

}  // namespace peclet::runner
