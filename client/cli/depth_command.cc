#include <filesystem>
#include <iostream>

#include "client/cli/command.h"
#include "client/cli/depth_files.h"
#include "client/cli/depth_statistics.h"
#include "client/cli/interrupt.h"

namespace vs::cli {
namespace {

constexpr int64_t kSecondNs = 1'000'000'000;

struct DepthArguments {
  Argument<std::string> sequence;
  Argument<std::optional<int64_t>> frames;
  Argument<double> duration_s;
  Argument<std::string> out;
  Argument<std::string> stream;
  Argument<std::string> codec;
  Argument<double> max_fps;
  Argument<int64_t> window;
  Argument<bool> stats;
};

int64_t NowNs() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

v1::Codec ToCodec(const std::string& word) {
  if (word == "raw") return v1::CODEC_RAW;
  return word == "rvl+zstd" ? v1::CODEC_RVL_ZSTD : v1::CODEC_RVL;
}

// The stream that is meant: that with the given name, else the sequence's disparity, else its
// depth.
Result<std::string> FindStream(client::Client& client, const std::string& sequence,
                               const std::string& name) {
  VS_CLI_TRY(const v1::ListStreamsResponse response, client.ListStreams());
  std::string depth;
  std::string all;
  for (const v1::StreamInfo& stream : response.streams()) {
    if (!stream.stream().starts_with(sequence + "/")) continue;
    const std::string own_name = stream.stream().substr(sequence.size() + 1);
    all += (all.empty() ? "" : ", ") + own_name;
    if (name.empty() ? stream.kind() == v1::STREAM_KIND_DISPARITY : own_name == name) {
      return stream.stream();
    }
    if (stream.kind() == v1::STREAM_KIND_DEPTH && depth.empty()) depth = stream.stream();
  }
  if (!name.empty() && !all.empty()) {
    return client::Failure(client::Code::kNotFound,
                           sequence + " has no stream \"" + name + "\"; there are " + all);
  }
  if (!depth.empty()) return depth;
  // Tells a sequence that is not there from one that only publishes nothing.
  VS_CLI_TRY(const v1::SequenceState state, client.GetSequenceState(sequence));
  const bool stopped = state.state() == v1::SEQUENCE_RUN_STATE_STOPPED;
  return client::Failure(
      client::Code::kFailedPrecondition,
      sequence + (stopped ? " does not run; visionctl sequences start " + sequence
                          : " publishes no depth; visionctl streams list shows "
                            "what there is"));
}

// Prints as it goes and at the end.
class Report {
 public:
  Report(const Session& session, bool stats) : json_(session.options().json), stats_(stats) {}

  void Frame(const client::DepthFrame& frame, std::optional<double> latency_ms) {
    const int64_t now_ns = NowNs();
    all_.Add(frame, latency_ms, now_ns);
    lately_.Add(frame, latency_ms, now_ns);
    if (lately_from_ns_ == 0) lately_from_ns_ = now_ns;
    if (!stats_ || json_ || now_ns - lately_from_ns_ < kSecondNs) return;
    PrintLine(lately_.ToText());
    std::cout.flush();
    // The next second begins with this very frame.
    lately_ = DepthStatistics();
    lately_.Add(frame, latency_ms, now_ns);
    lately_from_ns_ = now_ns;
  }

  void End(const client::StreamStats& stream) const {
    if (json_) {
      std::cout << all_.ToJson(stream) << "\n";
    } else if (stats_) {
      PrintLine("all " + std::to_string(all_.frames()) + " frames: " + all_.ToText());
    } else {
      PrintLine(std::to_string(all_.frames()) + " frames");
    }
  }

 private:
  const bool json_;
  const bool stats_;
  DepthStatistics all_;
  DepthStatistics lately_;
  int64_t lately_from_ns_ = 0;
};

// The next frame; nothing when Ctrl-C or `end_ns` comes first.
Result<std::optional<client::DepthFrame>> Next(client::DepthStream& depth, const Session& session,
                                               const Interrupt& interrupt, int64_t end_ns) {
  const auto deadline = std::chrono::steady_clock::now() + session.timeout();
  while (!interrupt.requested() && NowNs() < end_ns) {
    Result<client::DepthFrame> frame = depth.Next(Interrupt::kGlance);
    if (frame) return std::optional(std::move(*frame));
    if (frame.error().code != client::Code::kDeadlineExceeded) return tl::unexpected(frame.error());
    if (std::chrono::steady_clock::now() >= deadline) {
      const std::string& why = frame.error().message;
      const size_t colon = why.find(": ");
      return client::Failure(client::Code::kDeadlineExceeded,
                             "no depth came within " + NumberText(session.options().timeout_s, 1) +
                                 " s" + (colon == std::string::npos ? "" : why.substr(colon)),
                             frame.error().reason);
    }
  }
  return std::optional<client::DepthFrame>();
}

Result<void> Depth(Session& session, const DepthArguments& arguments) {
  VS_CLI_TRY(client::Client * client, session.Connect());
  VS_CLI_TRY(const std::string name, FindStream(*client, *arguments.sequence, *arguments.stream));
  const bool writes = !arguments.out->empty();
  if (writes) {
    std::error_code error;
    std::filesystem::create_directories(*arguments.out, error);
    if (error) {
      return client::Failure(client::Code::kUnknown,
                             "cannot make the folder " + *arguments.out + ": " + error.message());
    }
  }
  const Result<client::ServerClock> clock = client->ReadServerClock();
  const Interrupt interrupt;
  client::DepthStream depth =
      client->OpenDepth(name, {.codec = ToCodec(*arguments.codec),
                               .window = static_cast<uint32_t>(*arguments.window),
                               .max_fps = *arguments.max_fps});
  Report report(session, *arguments.stats);
  const int64_t end_ns =
      *arguments.duration_s == 0
          ? INT64_MAX
          : NowNs() + static_cast<int64_t>(*arguments.duration_s * static_cast<double>(kSecondNs));
  const int64_t frames = arguments.frames->value_or(*arguments.duration_s == 0 ? 1 : 0);
  for (int64_t count = 1; frames == 0 || count <= frames; ++count) {
    VS_CLI_TRY(const std::optional<client::DepthFrame> frame,
               Next(depth, session, interrupt, end_ns));
    if (!frame && !interrupt.requested() && count == 1) {
      return client::Failure(client::Code::kDeadlineExceeded,
                             "no depth came within " + NumberText(*arguments.duration_s, 1) + " s");
    }
    if (!frame) break;
    std::optional<double> latency_ms;
    if (clock && frame->capture_ns != 0) {
      latency_ms = static_cast<double>(NowNs() + clock->offset_ns - frame->capture_ns) / 1e6;
    }
    if (writes) {
      auto written = WriteDepthFiles(*frame, name, latency_ms.value_or(-1), count, *arguments.out);
      if (!written) return written;
    }
    report.Frame(*frame, latency_ms);
  }
  report.End(depth.stats());
  return {};
}

}  // namespace

void AddDepthCommand(CommandLine& line) {
  Command& depth = line.Add("depth", "Receive depth from a running sequence: store it, measure it");
  const DepthArguments arguments = {
      .sequence = depth.Positional("SEQUENCE", "Its id, see sequences list"),
      .frames = depth.OptionalCount(
          "--frames", "How many; 0: until Ctrl-C (otherwise 1, or with --duration all)", 0,
          1'000'000'000),
      .duration_s = depth.Number("--duration", "End after so many seconds; 0: do not", 0, 0, 1e9),
      .out =
          depth.Text("--out", "DIR",
                     "Write each frame there as a PNG of 16 bits (disparity in px = value / 256, "
                     "0 invalid) and a JSON file with geometry, times and drops"),
      .stream = depth.Text("--stream", "NAME",
                           "Which of the sequence's streams (otherwise its disparity)"),
      .codec = depth.Choice("--codec", "How depth is packed on the way", {"rvl", "rvl+zstd", "raw"},
                            "rvl"),
      .max_fps = depth.Number("--max-fps", "Not more frames per second; 0: all", 0, 0, 1e6),
      .window = depth.Count("--window", "Frames under way at once", 2, 1, 16),
      .stats = depth.Flag("--stats",
                          "Print rate, latency from exposure to here, drops and bytes: each second "
                          "and at the end")};
  depth.Example("visionctl depth stereo_depth --frames 100 --stats")
      .Example("visionctl depth stereo_depth --frames 10 --out depth/");
  depth.Run([arguments](Session& session) { return Depth(session, arguments); });
}

}  // namespace vs::cli
