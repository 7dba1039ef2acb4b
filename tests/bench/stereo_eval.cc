// How exact the matcher is on pairs of pictures with ground truth.
//
//   stereo_eval --data DIR [--preset NAME] [--set FIELD=VALUE ...] [--backend NAME] [--threads N]
//               [--noise SIGMA] [--right-gain FACTOR] [--write OUT] [--peers] [--ablation]
//               [--rounds N] [--json]
//   stereo_eval --import-aloe DIR      writes the pair of Debian's opencv-doc as a scene
//
// DIR holds a folder for each scene: left.png, right.png, disp.png (16 bit, disparity in px = value
// / 256, 0 = unknown), nonocc.png (255 = seen by both cameras) and meta.json (name,
// num_disparities). All settings are the same for all scenes but the range, which is the scene's.
// The time is the median of the rounds; in each round all variants take their turn.
// Percentages are of the pixels that both cameras see and whose truth is known.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "engine/base/str.h"
#include "engine/image/png.h"
#include "engine/stereo/quality.h"
#include "engine/stereo/sgm_presets.h"
#include "engine/stereo/stereo_matcher.h"
#include "tests/bench/opencv_peers.h"
#include "tests/bench/sgm_options.h"
#include "tests/support/stereo_scene.h"

namespace vs::test {
namespace {

struct Options {
  std::string data;
  std::string preset = "quality";
  std::vector<std::string> set;
  std::string backend = "auto";
  int threads = 2;
  int rounds = 1;
  std::string write;
  std::string import_aloe;
  double noise = 0;
  double right_gain = 1;
  bool peers = false;
  bool ablation = false;
  bool json = false;
};

// One line of the table.
struct Score {
  double bad1 = 0;
  double bad2 = 0;
  double valid_bad2 = 0;
  double average_px = 0;
  double density = 0;
  double filled_bad2 = 0;
  double ms = 0;
};

// Settings under a name: the preset that was asked for, or what an ablation changes in it.
struct Variant {
  std::string name;
  std::vector<std::string> set;
};

std::vector<Variant> VariantsOf(const Options& options) {
  if (!options.ablation) return {{options.preset, {}}};
  return {{"all steps", {}},
          {"no grey term", {"cost=census"}},
          {"census 5x5", {"census=5x5"}},
          {"outside cost 14", {"outside_cost=14"}},
          {"costs as they are", {"smooth_cost=0"}},
          {"8 directions", {"directions=8"}},
          {"constant P2", {"p2_slope_permille=0"}},
          {"whole pixels", {"sub_pixel=off"}},
          {"strict views", {"left_right_lenient=0"}},
          {"one view", {"left_right_check=0"}},
          {"no median", {"median=0"}},
          {"median 3x3", {"median=3"}},
          {"no speckles", {"speckle_size=0"}},
          {"no gated median", {"gated_median=0"}},
          {"holes stay", {"fill_holes=0"}},
          {"background", {"fill_background=1"}},
          {"pre-blur", {"pre_blur=strong"}},
          {"no pre-blur", {"pre_blur=off"}},
          {"no gain match", {"match_gain=0"}},
          {"uniqueness 5 %", {"uniqueness_percent=5"}},
          {"confidence 40", {"min_confidence=40"}}};
}

// Each run of holes takes the lesser of the disparities beside it.
void FillRow(uint16_t* row, int width) {
  for (int x = 0; x < width;) {
    if (row[x] != kInvalidDisparity) {
      ++x;
      continue;
    }
    const int first = x;
    while (x < width && row[x] == kInvalidDisparity) ++x;
    const uint16_t before = first > 0 ? row[first - 1] : kInvalidDisparity;
    const uint16_t after = x < width ? row[x] : kInvalidDisparity;
    const bool both = before != kInvalidDisparity && after != kInvalidDisparity;
    std::fill(row + first, row + x, both ? std::min(before, after) : std::max(before, after));
  }
}

// The picture with a gain and with normally distributed noise, the same each time.
GreyImage Disturbed(const GreyImage& picture, double gain, double sigma, unsigned seed,
                    BufferPool& pool) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, sigma > 0 ? sigma : 1);
  GreyImage out(pool, picture.width(), picture.height());
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const double grey = picture.Row(y)[x] * gain + (sigma > 0 ? noise(random) : 0);
      out.Row(y)[x] = static_cast<uint8_t>(std::lround(std::clamp(grey, 0.0, 255.0)));
    }
  }
  return out;
}

// Of all pixels with known truth, after each hole took the farther of its neighbours in the row.
double FilledBad2(DisparityMap map, const StereoTruth& truth, BufferPool& pool) {
  DisparityMap filled{.disparity =
                          Image<uint16_t>(pool, map.disparity.width(), map.disparity.height())};
  int64_t pixels = 0;
  int64_t bad = 0;
  for (int y = 0; y < map.disparity.height(); ++y) {
    uint16_t* row = filled.disparity.Row(y);
    const int width = map.disparity.width();
    std::copy_n(map.disparity.Row(y), width, row);
    FillRow(row, width);
    for (int x = 0; x < width; ++x) {
      const double expected = truth.disparity_px.Row(y)[x];
      if (std::isnan(expected)) continue;
      ++pixels;
      const double found = static_cast<double>(row[x]) / kDisparityScale + map.offset_px;
      bad += std::abs(found - expected) > 2 ? 1 : 0;
    }
  }
  return pixels > 0 ? 100.0 * static_cast<double>(bad) / static_cast<double>(pixels) : 0;
}

Score ScoreOf(const DisparityMap& map, const StereoScene& scene, double ms, BufferPool& pool) {
  const TruthScore truth =
      *ScoreAgainstTruth(map, scene.truth, {0, 0, scene.left.width(), scene.left.height()});
  return {truth.bad1_percent,
          truth.bad2_percent,
          truth.valid_bad2_percent,
          truth.average_error_px,
          truth.valid_percent,
          FilledBad2(map, scene.truth, pool),
          ms};
}

class Table {
 public:
  explicit Table(bool json) : json_(json) {
    if (!json) {
      std::printf("%-14s %-18s %7s %7s %10s %8s %8s %11s %8s\n", "scene", "matcher", "bad-1",
                  "bad-2", "valid b-2", "avg px", "density", "filled b-2", "ms");
    }
  }
  void Add(const std::string& scene, const std::string& matcher, const Score& s) {
    Print(scene, matcher, s);
    if (counts_[matcher]++ == 0) order_.push_back(matcher);
    Score& sum = sums_[matcher];
    sum.bad1 += s.bad1;
    sum.bad2 += s.bad2;
    sum.valid_bad2 += s.valid_bad2;
    sum.average_px += s.average_px;
    sum.density += s.density;
    sum.filled_bad2 += s.filled_bad2;
    sum.ms += s.ms;
  }
  void PrintMeans() {
    for (const std::string& matcher : order_) {
      const Score& s = sums_[matcher];
      const double n = counts_[matcher];
      Print("mean", matcher,
            {s.bad1 / n, s.bad2 / n, s.valid_bad2 / n, s.average_px / n, s.density / n,
             s.filled_bad2 / n, s.ms / n});
    }
  }

 private:
  void Print(const std::string& scene, const std::string& matcher, const Score& s) const {
    if (json_) {
      std::printf("%s\n", nlohmann::json{{"scene", scene},
                                         {"matcher", matcher},
                                         {"bad1_percent", s.bad1},
                                         {"bad2_percent", s.bad2},
                                         {"valid_bad2_percent", s.valid_bad2},
                                         {"average_error_px", s.average_px},
                                         {"density_percent", s.density},
                                         {"filled_bad2_percent", s.filled_bad2},
                                         {"ms", s.ms}}
                              .dump()
                              .c_str());
    } else {
      std::printf("%-14s %-18s %7.2f %7.2f %10.2f %8.3f %8.2f %11.2f %8.1f\n", scene.c_str(),
                  matcher.c_str(), s.bad1, s.bad2, s.valid_bad2, s.average_px, s.density,
                  s.filled_bad2, s.ms);
    }
    std::fflush(stdout);
  }

  bool json_;
  std::vector<std::string> order_;
  std::map<std::string, int> counts_;
  std::map<std::string, Score> sums_;
};

Status WriteMap(const DisparityMap& map, const std::filesystem::path& path, BufferPool& pool) {
  Image<uint16_t> scaled(pool, map.disparity.width(), map.disparity.height());
  for (int y = 0; y < scaled.height(); ++y) {
    for (int x = 0; x < scaled.width(); ++x) {
      const int stored = map.disparity.Row(y)[x];
      const int value = stored * (256 / kDisparityScale) + 256 * map.offset_px;
      scaled.Row(y)[x] = stored == 0 ? 0 : static_cast<uint16_t>(std::clamp(value, 1, 65535));
    }
  }
  VS_ASSIGN_OR_RETURN(const auto png, EncodePng(scaled));
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(png.data()), static_cast<std::streamsize>(png.size()));
  if (!file.good()) return Unavailable(Str("cannot write ", path.string()));
  return Status();
}

Result<SgmSettings> SettingsOf(const Options& options, const Variant& variant) {
  VS_ASSIGN_OR_RETURN(SgmSettings settings, ApplySgmPreset(options.preset));
  for (const auto* assignments : {&options.set, &variant.set}) {
    for (const std::string& assignment : *assignments) {
      VS_RETURN_IF_ERROR(SetSgmField(assignment, &settings));
    }
  }
  return settings;
}

// A variant on one scene.
struct Turn {
  std::string name;
  SgmSettings settings;
  DisparityMap map;
  std::vector<double> times_ms;
};

// Matches twice: the first time asks for memory and gets the caches used to these settings.
Status Take(const StereoScene& scene, StereoMatcher& matcher, int threads, BufferPool& pool,
            Turn* turn) {
  double ms = 0;
  for (int run = 0; run < 2; ++run) {
    const auto begin = std::chrono::steady_clock::now();
    VS_ASSIGN_OR_RETURN(turn->map,
                        matcher.Match(scene.left, scene.right, turn->settings, threads, pool));
    ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  }
  turn->times_ms.push_back(ms);
  return Status();
}

double MedianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Status EvaluateScene(const Options& options, const std::filesystem::path& folder,
                     StereoMatcher& matcher, BufferPool& pool, Table* table) {
  VS_ASSIGN_OR_RETURN(StereoScene scene, LoadStereoScene(folder, pool));
  if (options.noise > 0 || options.right_gain != 1) {
    scene.left = Disturbed(scene.left, 1, options.noise, 1, pool);
    scene.right = Disturbed(scene.right, options.right_gain, options.noise, 2, pool);
  }
  std::vector<Turn> turns;
  for (const Variant& variant : VariantsOf(options)) {
    VS_ASSIGN_OR_RETURN(const SgmSettings settings, SettingsOf(options, variant));
    turns.push_back({.name = variant.name, .settings = settings});
    turns.back().settings.num_disparities = scene.num_disparities;
  }
  for (int round = 0; round < options.rounds; ++round) {
    for (Turn& turn : turns) {
      VS_RETURN_IF_ERROR(Take(scene, matcher, options.threads, pool, &turn));
    }
  }
  for (const Turn& turn : turns) {
    table->Add(scene.name, turn.name, ScoreOf(turn.map, scene, MedianOf(turn.times_ms), pool));
    if (!options.write.empty()) {
      const auto path =
          std::filesystem::path(options.write) / (folder.filename().string() + ".png");
      VS_RETURN_IF_ERROR(WriteMap(turn.map, path, pool));
    }
  }
  if (!options.peers) return Status();
  for (const OpenCvPeer& peer : OpenCvPeers()) {
    const PeerResult result =
        RunOpenCvPeer(peer, scene.left, scene.right, scene.num_disparities, pool);
    table->Add(scene.name, std::string(peer.name), ScoreOf(result.map, scene, result.ms, pool));
  }
  return Status();
}

Status Evaluate(const Options& options) {
  BufferPool pool;
  VS_ASSIGN_OR_RETURN(const auto matcher, StereoMatchers::Get().Make(options.backend));
  const std::vector<std::filesystem::path> folders = StereoSceneFoldersIn(options.data);
  if (folders.empty()) {
    return NotFound(Str("there is no scene (a folder with meta.json) in ", options.data));
  }
  if (!options.write.empty()) std::filesystem::create_directories(options.write);
  Table table(options.json);
  for (const auto& folder : folders) {
    VS_RETURN_IF_ERROR(EvaluateScene(options, folder, *matcher, pool, &table));
  }
  table.PrintMeans();
  return Status();
}

int Main(int argc, char** argv) {
  Options options;
  CLI::App app("How exact the matcher is on pairs of pictures with ground truth.", "stereo_eval");
  app.add_option("--data", options.data, "Folder with a folder for each scene");
  app.add_option("--preset", options.preset, "Settings to begin with")->capture_default_str();
  app.add_option("--set", options.set, "A setting: FIELD=VALUE");
  app.add_option("--backend", options.backend, "Which matcher")->capture_default_str();
  app.add_option("--threads", options.threads)->check(CLI::Range(1, 1000))->capture_default_str();
  app.add_option("--rounds", options.rounds, "How often each is timed")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--write", options.write, "Folder that takes the maps");
  app.add_option("--import-aloe", options.import_aloe,
                 "Write the aloe pair of Debian's opencv-doc to this folder as a scene");
  app.add_option("--noise", options.noise, "Noise added to both pictures, grey levels (sigma)");
  app.add_option("--right-gain", options.right_gain, "Gain applied to the right picture");
  app.add_flag("--peers", options.peers, "OpenCV's StereoSGBM too");
  app.add_flag("--ablation", options.ablation, "The preset with one step changed at a time");
  app.add_flag("--json", options.json, "One object for each line");
  CLI11_PARSE(app, argc, argv);
  Status status;
  if (!options.import_aloe.empty()) {
    BufferPool pool;
    const auto scene = LoadAloe(pool);
    status = scene ? WriteStereoScene(*scene, std::filesystem::path(options.import_aloe) / "aloe")
                   : scene.error();
  } else if (options.data.empty()) {
    status = InvalidArgument("--data DIR is missing; see --help");
  } else {
    status = Evaluate(options);
  }
  if (status.ok()) return 0;
  std::fprintf(stderr, "stereo_eval: %s\n", status.ToString().c_str());
  return 1;
}

}  // namespace
}  // namespace vs::test

int main(int argc, char** argv) { return vs::test::Main(argc, argv); }
