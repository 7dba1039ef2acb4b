// From a row of winners to disparities: the rules of selection.h without a branch that depends on a
// pixel. Part of filter_kernels_of.h, whose first words hold here too.
#pragma once

#include <cstdint>

#include "engine/image/disparity_map.h"
#include "engine/stereo/filter_kernels.h"

// NOLINTBEGIN(misc-definitions-in-headers): each file that includes this shall have its own.
namespace {

// One register of this instruction set.
#if defined(__AVX512BW__)
constexpr int kRegisterBytes = 64;
#elif defined(__AVX2__)
constexpr int kRegisterBytes = 32;
#else
constexpr int kRegisterBytes = 16;
#endif
using Ints = int32_t __attribute__((vector_size(kRegisterBytes)));
using Floats = float __attribute__((vector_size(kRegisterBytes)));
constexpr int kIntCount = kRegisterBytes / 4;

inline Ints AllInts(int value) { return Ints{} + value; }

// 0, 1, 2 ...
inline Ints Steps() {
  int32_t values[kIntCount];
  for (int k = 0; k < kIntCount; ++k) values[k] = k;
  Ints ints;
  __builtin_memcpy(&ints, values, sizeof ints);
  return ints;
}

// As many bytes and words. By way of words: from bytes at once the compiler (GCC 12) goes one by
// one.
using FewBytes = uint8_t __attribute__((vector_size(kIntCount)));
using FewWords = uint16_t __attribute__((vector_size(2 * kIntCount)));

inline Ints LoadInts(const uint16_t* from) {
  FewWords words;
  __builtin_memcpy(&words, from, sizeof words);
  return __builtin_convertvector(words, Ints);
}
inline Ints LoadInts(const uint8_t* from) {
  FewBytes bytes;
  __builtin_memcpy(&bytes, from, sizeof bytes);
  return __builtin_convertvector(__builtin_convertvector(bytes, FewWords), Ints);
}
inline void StoreInts(const Ints& ints, uint16_t* to) {
  const auto words = __builtin_convertvector(ints, FewWords);
  __builtin_memcpy(to, &words, sizeof words);
}
inline void StoreInts(const Ints& ints, uint8_t* to) {
  const auto bytes = __builtin_convertvector(__builtin_convertvector(ints, FewWords), FewBytes);
  __builtin_memcpy(to, &bytes, sizeof bytes);
}

// a / b in integers, for a of 0..2^17 and b of 1..2^10, by the division of floats. Exact: both are
// floats, and a quotient that is no integer is at least 1 / b below the next one, more than
// rounding can add.
inline Ints Quotient(Ints a, Ints b) {
  return __builtin_convertvector(
      __builtin_convertvector(a, Floats) / __builtin_convertvector(b, Floats), Ints);
}

template <vs::SubPixel kMethod>
inline Ints SubPixelSixteenths(Ints before, Ints best, Ints after) {
  if constexpr (kMethod == vs::SubPixel::kOff) return Ints{};
  const Ints divisor = kMethod == vs::SubPixel::kEquiangular
                           ? (before > after ? before : after) - best
                           : before + after - 2 * best;
  // floor((2 n + divisor) / (2 divisor)), made positive for the integer division: n >= -8 divisor.
  const Ints numerator = 16 * (before - after) + 17 * divisor;
  const Ints some = divisor > 0 ? 2 * divisor : AllInts(1);
  return divisor > 0 ? Quotient(numerator, some) - 8 : Ints{};
}

constexpr int Code(vs::InvalidReason reason) { return static_cast<int>(reason); }

// So many pixels are judged at a time, so that what is noted of them stays at hand.
constexpr int kJudgeBlock = 256;
static_assert(kIntCount <= vs::kMinPictureSize && vs::kMinPictureSize <= kJudgeBlock / 2);
constexpr int kTextureRadius = 2;
constexpr int kLeastTexture = 8;
constexpr int kSaturatedGrey = 254;
constexpr int kDarkGrey = 3;

struct JudgeNotes {
  uint8_t shown[kJudgeBlock];  // what Explain puts before its `reason`, else 0
  // The right view's winners at x - d - 1 (at 0 if that is outside) and, in the high byte, after
  // it.
  uint16_t right[kJudgeBlock];
};

// Greys side by side, few enough for the narrowest picture.
using Greys = uint8_t __attribute__((vector_size(16)));
constexpr int kGreyCount = sizeof(Greys);
static_assert(kGreyCount <= vs::kMinPictureSize);

inline Greys LoadGreys(const uint8_t* from) {
  Greys greys;
  __builtin_memcpy(&greys, from, sizeof greys);
  return greys;
}
inline void StoreGreys(const Greys& greys, uint8_t* to) {
  __builtin_memcpy(to, &greys, sizeof greys);
}
inline Greys Lesser(Greys a, Greys b) { return a < b ? a : b; }
inline Greys Greater(Greys a, Greys b) { return a > b ? a : b; }

// Notes what the picture shows at the pixels [begin, end).
void NoteWhatIsShown(const vs::JudgedRow& row, int begin, int end, uint8_t* shown) {
  constexpr int kReach = kTextureRadius;
  // The extremes of each column of the windows; beyond the picture those of the border.
  uint8_t low[kJudgeBlock + 2 * kReach];
  uint8_t high[kJudgeBlock + 2 * kReach];
  const int first = begin - kReach;  // of these columns
  const int inside_begin = first < 0 ? 0 : first;
  const int inside_end = end + kReach < row.width ? end + kReach : row.width;
  for (int x = inside_begin; x < inside_end; x += kGreyCount) {
    // The last piece ends with the row.
    const int from = x + kGreyCount <= inside_end ? x : inside_end - kGreyCount;
    Greys least = LoadGreys(row.left[0] + from);
    Greys greatest = least;
    for (int k = 1; k <= 2 * kReach; ++k) {
      const Greys greys = LoadGreys(row.left[k] + from);
      least = Lesser(least, greys);
      greatest = Greater(greatest, greys);
    }
    StoreGreys(least, low + (from - first));
    StoreGreys(greatest, high + (from - first));
  }
  for (int x = first; x < inside_begin; ++x) {
    low[x - first] = low[inside_begin - first];
    high[x - first] = high[inside_begin - first];
  }
  for (int x = inside_end; x < end + kReach; ++x) {
    low[x - first] = low[inside_end - 1 - first];
    high[x - first] = high[inside_end - 1 - first];
  }
  constexpr auto kCode = [](vs::InvalidReason reason) {
    return Greys{} + static_cast<uint8_t>(reason);
  };
  for (int x = begin; x < end; x += kGreyCount) {
    const int from = x + kGreyCount <= end ? x : end - kGreyCount;
    Greys least = LoadGreys(low + (from - begin));
    Greys greatest = LoadGreys(high + (from - begin));
    for (int k = 1; k <= 2 * kReach; ++k) {
      least = Lesser(least, LoadGreys(low + (from - begin) + k));
      greatest = Greater(greatest, LoadGreys(high + (from - begin) + k));
    }
    const Greys greys = LoadGreys(row.left[kReach] + from);
    Greys code = greatest - least < kLeastTexture ? kCode(vs::InvalidReason::kLowTexture) : Greys{};
    code = greys <= kDarkGrey ? kCode(vs::InvalidReason::kDark) : code;
    code = greys >= kSaturatedGrey ? kCode(vs::InvalidReason::kSaturated) : code;
    StoreGreys(code, shown + (from - begin));
  }
}

// Notes the right view's winners about the counterparts of the pixels [begin, end); anything where
// these are outside.
void NoteTheRightView(const vs::JudgedRow& row, int begin, int end, uint16_t* notes) {
  const uint8_t* const right = row.right_index;
  const uint8_t* const index = row.winners.index + begin;
  const int first = begin - row.min_disparity;
  const int last = row.width - 1;
  uint16_t places[kJudgeBlock];
  for (int x = 0; x < end - begin; ++x) {
    const int counterpart = first + x - index[x];
    const int place = counterpart > last ? last : counterpart;
    places[x] = static_cast<uint16_t>(place < 1 ? 0 : place - 1);
  }
  for (int x = 0; x < end - begin; ++x) {
    __builtin_memcpy(notes + x, right + places[x], sizeof *notes);
  }
}

// V for winners whose counterparts are not outside.
inline Ints ViewDifference(const uint16_t* notes, Ints index, Ints counterpart, bool lenient) {
  const auto distance = [&](Ints right) { return right < index ? index - right : right - index; };
  const Ints pair = LoadInts(notes);
  const Ints before = distance(pair & 0xff);
  const Ints after = distance(pair >> 8);
  const Ints difference = counterpart > 0 ? after : before;
  const Ints lesser = before < difference ? before : difference;
  return lenient ? lesser : difference;
}

// All pixels side by side; each rule overrules those after it, which therefore come first.
template <vs::SubPixel kMethod>
inline __attribute__((always_inline)) void JudgePixels(const vs::JudgedRow& row, int from,
                                                       const JudgeNotes& notes, int note) {
  const vs::WinnerRow& winners = row.winners;
  const Ints index = LoadInts(winners.index + from);
  const Ints best = LoadInts(winners.best + from);
  const Ints second = LoadInts(winners.second + from);
  const Ints between = (index > 0) & (index < AllInts(row.last_index));
  const Ints sixteenths = SubPixelSixteenths<kMethod>(LoadInts(winners.before + from), best,
                                                      LoadInts(winners.after + from));
  const Ints stored = row.first_stored + 16 * index + (between & sixteenths);

  const Ints counterpart = (from - row.min_disparity) + Steps() - index;
  const Ints outside = (counterpart < 0) | (counterpart >= AllInts(row.width));
  Ints difference = {};
  if (row.right_index != nullptr) {
    difference = ViewDifference(notes.right + note, index, counterpart, row.lenient);
  }
  const Ints shift = difference < 8 ? difference : AllInts(8);
  const Ints margin = Quotient(255 * (second - best), second > 0 ? second : AllInts(1)) >> shift;
  const Ints confidence = margin > 2 ? margin : AllInts(2);

  const Ints shown = LoadInts(notes.shown + note);
  const auto explain = [&](vs::InvalidReason reason) {
    return shown != 0 ? shown : AllInts(Code(reason));
  };
  Ints reason = confidence < AllInts(row.min_confidence)
                    ? AllInts(Code(vs::InvalidReason::kFiltered))
                    : Ints{};
  reason =
      second * row.least_percent < best * 100 ? explain(vs::InvalidReason::kAmbiguous) : reason;
  Ints why = explain(vs::InvalidReason::kOccluded);
  why = index == AllInts(row.last_index) ? AllInts(Code(vs::InvalidReason::kOutOfRangeNear)) : why;
  const Ints far = AllInts(Code(vs::InvalidReason::kOutOfRangeFar));
  why = index == 0 ? far : why;
  reason = difference > AllInts(row.tolerance) ? why : reason;
  reason = stored <= 0 ? far : reason;
  reason = outside ? AllInts(Code(vs::InvalidReason::kBorder)) : reason;

  StoreInts(reason == 0 ? stored : Ints{}, row.disparity + from);
  StoreInts(reason == 0 ? confidence : Ints{}, row.confidence + from);
  StoreInts(reason, row.reason + from);
}

template <vs::SubPixel kMethod>
void JudgeWinners(const vs::JudgedRow& given) {
  const vs::JudgedRow row = given;  // a copy that no byte that is stored could change
  const int blocks = (row.width + kJudgeBlock - 1) / kJudgeBlock;
  JudgeNotes notes;
  for (int block = 0; block < blocks; ++block) {
    const int begin = row.width * block / blocks;
    const int end = row.width * (block + 1) / blocks;
    NoteWhatIsShown(row, begin, end, notes.shown);
    if (row.right_index != nullptr) NoteTheRightView(row, begin, end, notes.right);
    for (int x = begin; x < end; x += kIntCount) {
      // The last piece ends with the block.
      const int from = x + kIntCount <= end ? x : end - kIntCount;
      JudgePixels<kMethod>(row, from, notes, from - begin);
    }
  }
}

void Judge(const vs::JudgedRow& row) {
  switch (row.sub_pixel) {
    case vs::SubPixel::kOff:
      return JudgeWinners<vs::SubPixel::kOff>(row);
    case vs::SubPixel::kParabola:
      return JudgeWinners<vs::SubPixel::kParabola>(row);
    case vs::SubPixel::kEquiangular:
      return JudgeWinners<vs::SubPixel::kEquiangular>(row);
  }
}

}  // namespace
// NOLINTEND(misc-definitions-in-headers)
