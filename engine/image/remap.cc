#include "engine/image/remap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace vs {
namespace {

// A pixel and what part of the way to its right and lower neighbours.
template <class Part>
struct Place {
  int x;
  int y;
  Part x_part;
  Part y_part;
};

template <class Number, size_t kTaps>
using Weights = std::array<Number, kTaps>;

// Places in 1/32 px, weights in whole numbers.
struct Fixed {
  using Entry = RemapTable::Source;
  using Part = uint8_t;
  static constexpr int kParts = 32;

  static const std::vector<Entry>& EntriesOf(const RemapTable& table) { return table.sources; }
  static Place<Part> PlaceOf(const Entry& entry) {
    return {entry.x, entry.y, entry.x_part, entry.y_part};
  }
  static bool IsHalf(Part part) { return part >= kParts / 2; }
  // The sum of the weights is 2^5 and 2^17.
  static Weights<int64_t, 2> Linear(Part t) { return {kParts - t, t}; }
  static Weights<int64_t, 4> Cubic(Part part) {
    const int64_t t = part;
    const int64_t s = kParts - t;
    constexpr int64_t kNine = int64_t{9} * kParts;
    return {-3 * t * s * s, (5 * t - kNine) * t * t + (1 << 17),
            (5 * s - kNine) * s * s + (1 << 17), -3 * s * t * t};
  }
  template <size_t kTaps>
  static uint8_t Grey(int64_t sum) {
    constexpr int kBits = kTaps == 2 ? 10 : 34;
    return static_cast<uint8_t>(
        std::clamp<int64_t>((sum + (int64_t{1} << (kBits - 1))) >> kBits, 0, 255));
  }
  // What Linear and Grey make of four neighbours.
  static uint8_t MixFour(const uint8_t* above, const uint8_t* below, Part x_part, Part y_part) {
    const auto top = static_cast<int16_t>(kParts * above[0] + x_part * (above[1] - above[0]));
    const auto bottom = static_cast<int16_t>(kParts * below[0] + x_part * (below[1] - below[0]));
    return static_cast<uint8_t>((top * (kParts - y_part) + bottom * y_part + 512) >> 10);
  }
};

// Places and weights in floats.
struct Exact {
  using Entry = RemapTable::Position;
  using Part = float;

  static const std::vector<Entry>& EntriesOf(const RemapTable& table) { return table.positions; }
  static Place<Part> PlaceOf(const Entry& entry) {
    constexpr float kFar = 32768;  // farther outside than any picture is wide; nor is NaN nearer
    const bool near = std::abs(entry.x) < kFar && std::abs(entry.y) < kFar;
    const float x = near ? entry.x : -kFar;
    const float y = near ? entry.y : -kFar;
    const int left = RoundedDown(x);
    const int top = RoundedDown(y);
    return {left, top, x - static_cast<float>(left), y - static_cast<float>(top)};
  }
  // std::floor would be a call for each.
  static int RoundedDown(float value) {
    const int whole = static_cast<int>(value);
    return whole - static_cast<int>(static_cast<float>(whole) > value);
  }
  static bool IsHalf(Part part) { return part >= 0.5F; }
  static Weights<float, 2> Linear(Part t) { return {1 - t, t}; }
  static Weights<float, 4> Cubic(Part t) {
    const float s = 1 - t;
    return {-0.75F * t * s * s, (1.25F * t - 2.25F) * t * t + 1, (1.25F * s - 2.25F) * s * s + 1,
            -0.75F * s * t * t};
  }
  template <size_t kTaps>
  static uint8_t Grey(float sum) {
    return static_cast<uint8_t>(std::clamp(sum + 0.5F, 0.0F, 255.0F));
  }
  static uint8_t MixFour(const uint8_t* above, const uint8_t* below, Part x_part, Part y_part) {
    const auto a = static_cast<float>(above[0]);
    const auto c = static_cast<float>(below[0]);
    const float top = a + x_part * (static_cast<float>(above[1]) - a);
    const float bottom = c + x_part * (static_cast<float>(below[1]) - c);
    // NOLINTNEXTLINE(bugprone-incorrect-roundings): never negative.
    return static_cast<uint8_t>(static_cast<int>(top + y_part * (bottom - top) + 0.5F));
  }
};

// The weighted sum of the kTaps x kTaps pixels about a place, wherever it is.
template <class Kind, class Number, size_t kTaps>
uint8_t Interpolate(const GreyImage& in, int x, int y, const Weights<Number, kTaps>& across,
                    const Weights<Number, kTaps>& down) {
  constexpr int kCount = static_cast<int>(kTaps);
  const int left = x + 1 - kCount / 2;
  const int top = y + 1 - kCount / 2;
  const int u_end = std::min(kCount, in.width() - left);
  const int v_end = std::min(kCount, in.height() - top);
  Number sum = 0;
  for (int v = std::max(-top, 0); v < v_end; ++v) {
    const uint8_t* row = in.Row(top + v);
    Number row_sum = 0;
    for (int u = std::max(-left, 0); u < u_end; ++u) {
      row_sum += across[static_cast<size_t>(u)] * static_cast<Number>(row[left + u]);
    }
    sum += down[static_cast<size_t>(v)] * row_sum;
  }
  return Kind::template Grey<kTaps>(sum);
}

template <class Kind>
uint8_t Nearest(const GreyImage& in, const typename Kind::Entry& entry) {
  const auto place = Kind::PlaceOf(entry);
  const int x = place.x + (Kind::IsHalf(place.x_part) ? 1 : 0);
  const int y = place.y + (Kind::IsHalf(place.y_part) ? 1 : 0);
  const bool inside = x >= 0 && y >= 0 && x < in.width() && y < in.height();
  return inside ? in.Row(y)[x] : uint8_t{0};
}

template <class Kind>
uint8_t Linear(const GreyImage& in, const typename Kind::Entry& entry) {
  const auto place = Kind::PlaceOf(entry);
  return Interpolate<Kind>(in, place.x, place.y, Kind::Linear(place.x_part),
                           Kind::Linear(place.y_part));
}

template <class Kind>
uint8_t Cubic(const GreyImage& in, const typename Kind::Entry& entry) {
  const auto place = Kind::PlaceOf(entry);
  return Interpolate<Kind>(in, place.x, place.y, Kind::Cubic(place.x_part),
                           Kind::Cubic(place.y_part));
}

// A row, in pieces: first everything is fetched, pixel by pixel, then all is mixed side by side.
template <class Kind>
void LinearRow(const GreyImage& in, const typename Kind::Entry* entries, int count, uint8_t* out) {
  constexpr ptrdiff_t kPiece = 64;
  uint8_t above[2 * kPiece];
  uint8_t below[2 * kPiece];
  typename Kind::Part x_parts[kPiece];
  typename Kind::Part y_parts[kPiece];
  const uint8_t* origin = in.Row(0);
  const auto stride = static_cast<ptrdiff_t>(in.stride_bytes());
  const auto columns = static_cast<unsigned>(in.width() - 1);
  const auto rows = static_cast<unsigned>(in.height() - 1);
  for (ptrdiff_t begin = 0; begin < count; begin += kPiece) {
    const ptrdiff_t size = std::min(kPiece, count - begin);
    bool inside[kPiece];
    bool all_inside = true;
    for (ptrdiff_t k = 0; k < size; ++k) {
      const auto place = Kind::PlaceOf(entries[begin + k]);
      inside[k] = static_cast<unsigned>(place.x) < columns && static_cast<unsigned>(place.y) < rows;
      all_inside = all_inside && inside[k];
      const uint8_t* at = inside[k] ? origin + place.y * stride + place.x : origin;
      std::memcpy(above + 2 * k, at, 2);
      std::memcpy(below + 2 * k, at + (inside[k] ? stride : 0), 2);
      x_parts[k] = place.x_part;
      y_parts[k] = place.y_part;
    }
    if (all_inside) {
      for (ptrdiff_t k = 0; k < size; ++k) {
        out[begin + k] = Kind::MixFour(above + 2 * k, below + 2 * k, x_parts[k], y_parts[k]);
      }
    } else {
      for (ptrdiff_t k = 0; k < size; ++k) {
        out[begin + k] = inside[k]
                             ? Kind::MixFour(above + 2 * k, below + 2 * k, x_parts[k], y_parts[k])
                             : Linear<Kind>(in, entries[begin + k]);
      }
    }
  }
}

template <class Kind>
void RemapBy(const GreyImage& in, const RemapTable& table, Interpolation interpolation,
             GreyImage* out) {
  const typename Kind::Entry* entries = Kind::EntriesOf(table).data();
  for (int y = 0; y < table.height; ++y, entries += table.width) {
    uint8_t* row = out->Row(y);
    switch (interpolation) {
      case Interpolation::kNearest:
        for (int x = 0; x < table.width; ++x) row[x] = Nearest<Kind>(in, entries[x]);
        break;
      case Interpolation::kLinear:
        LinearRow<Kind>(in, entries, table.width, row);
        break;
      case Interpolation::kCubic:
        for (int x = 0; x < table.width; ++x) row[x] = Cubic<Kind>(in, entries[x]);
        break;
    }
  }
}

}  // namespace

void Remap(const GreyImage& in, const RemapTable& table, Interpolation interpolation,
           GreyImage* out) {
  if (table.positions.empty()) {
    RemapBy<Fixed>(in, table, interpolation, out);
  } else {
    RemapBy<Exact>(in, table, interpolation, out);
  }
}

}  // namespace vs
