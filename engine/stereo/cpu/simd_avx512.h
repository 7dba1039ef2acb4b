#pragma once

#include <immintrin.h>

#include <cstddef>
#include <cstdint>

namespace {

// 64 bytes side by side on AVX-512 (BW, VBMI, BITALG); simd_portable.h says what each name means.
struct Simd {
  static constexpr int kLanes = 64;
  static constexpr int kRegisters = 32;
  struct V {
    __m512i v;
  };

  static V Load(const uint8_t* p) { return {_mm512_load_si512(p)}; }
  static V LoadAnywhere(const uint8_t* p) { return {_mm512_loadu_si512(p)}; }
  static void Store(uint8_t* p, V a) { _mm512_store_si512(p, a.v); }
  static void StoreAnywhere(uint8_t* p, V a) { _mm512_storeu_si512(p, a.v); }
  static void Stream(uint8_t* p, V a) { _mm512_stream_si512(reinterpret_cast<__m512i*>(p), a.v); }
  static void EndStream() { _mm_sfence(); }
  static V Set(uint8_t a) { return {_mm512_set1_epi8(static_cast<char>(a))}; }
  template <int n>
  static V EveryNth(const uint8_t* last) {
    // Piece j of n ends at last[-64 * j]; lane k comes from piece k * n / 64.
    static constexpr Places<n> kPlaces;
    const __m512i places = _mm512_load_si512(kPlaces.of);
    __m512i a = _mm512_setzero_si512();
#pragma GCC unroll 4
    for (int j = 0; j < n; ++j) {
      a = _mm512_mask_permutexvar_epi8(a, kPlaces.lanes[j], places,
                                       _mm512_loadu_si512(last - ptrdiff_t{64} * j - 63));
    }
    return {a};
  }

  static V Min(V a, V b) { return {_mm512_min_epu8(a.v, b.v)}; }
  static V Max(V a, V b) { return {_mm512_max_epu8(a.v, b.v)}; }
  static V Add(V a, V b) { return {_mm512_add_epi8(a.v, b.v)}; }
  static V AddSaturated(V a, V b) { return {_mm512_adds_epu8(a.v, b.v)}; }
  static V Subtract(V a, V b) { return {_mm512_sub_epi8(a.v, b.v)}; }
  static V SubtractSaturated(V a, V b) { return {_mm512_subs_epu8(a.v, b.v)}; }
  static V Magnitude(V a) { return {_mm512_abs_epi8(a.v)}; }
  static V Average(V a, V b) { return {_mm512_avg_epu8(a.v, b.v)}; }
  static V Xor(V a, V b) { return {_mm512_xor_si512(a.v, b.v)}; }
  static V Or(V a, V b) { return {_mm512_or_si512(a.v, b.v)}; }
  static V BitCount(V a) { return {_mm512_popcnt_epi8(a.v)}; }
  static V BitCountOfThree(V a, V b, V c) {
    return Add(Add(BitCount(a), BitCount(b)), BitCount(c));
  }

  static V IfEqual(V a, V b, V yes, V no) {
    return {_mm512_mask_blend_epi8(_mm512_cmpeq_epu8_mask(a.v, b.v), no.v, yes.v)};
  }
  static V IfLess(V a, V b, V yes, V no) {
    return {_mm512_mask_blend_epi8(_mm512_cmplt_epu8_mask(a.v, b.v), no.v, yes.v)};
  }
  static void TakeLess(V a, V of_a, V* least, V* index) {
    *index = IfLess(a, *least, of_a, *index);
    *least = Min(a, *least);
  }
  static void TakeLeast(V a, V of_a, V* least, V* index) {
    *index = IfLess(*least, a, *index, of_a);
    *least = Min(a, *least);
  }
  using Exception = uint64_t;  // the other lanes
  static constexpr Exception kNoException = ~0ULL;
  static constexpr Exception Except(int lane) { return ~(1ULL << lane); }
  static V MinBut(V a, V b, Exception others) {
    return {_mm512_mask_min_epu8(a.v, others, a.v, b.v)};
  }

  static V FromBelow(V a, uint8_t guard) {
    return {_mm512_mask_permutexvar_epi8(Set(guard).v, ~1ULL, _mm512_load_si512(kDown), a.v)};
  }
  static V FromAbove(V a, uint8_t guard) {
    return {_mm512_mask_permutexvar_epi8(Set(guard).v, ~0ULL >> 1, _mm512_load_si512(kUp), a.v)};
  }

  static V LeastOfAll(V a) { return {_mm512_broadcastb_epi8(Least(a))}; }
  static uint8_t LeastByte(V a) { return static_cast<uint8_t>(_mm_cvtsi128_si32(Least(a))); }
  // Pairs: sixteen bits each, the first argument above the second.
  static V PairLow(V high, V low) { return {_mm512_unpacklo_epi8(low.v, high.v)}; }
  static V PairHigh(V high, V low) { return {_mm512_unpackhi_epi8(low.v, high.v)}; }
  static V MinPairs(V a, V b) { return {_mm512_min_epu16(a.v, b.v)}; }
  static int LeastPair(V a) {
    const __m256i half =
        _mm256_min_epu16(_mm512_castsi512_si256(a.v), _mm512_extracti64x4_epi64(a.v, 1));
    const __m128i quarter =
        _mm_min_epu16(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1));
    return _mm_cvtsi128_si32(_mm_minpos_epu16(quarter)) & 0xffff;
  }
  static uint64_t ZeroLanes(V a) { return _mm512_testn_epi8_mask(a.v, a.v); }
  static uint8_t First(V a) {
    return static_cast<uint8_t>(_mm_cvtsi128_si32(_mm512_castsi512_si128(a.v)));
  }
  static uint8_t Last(V a) {
    return static_cast<uint8_t>(_mm_extract_epi8(_mm512_extracti32x4_epi32(a.v, 3), 15));
  }

 private:
  template <int n>
  struct Places {
    alignas(64) uint8_t of[64] = {};  // by lane, in its piece
    uint64_t lanes[n] = {};           // by piece

    constexpr Places() {
      for (int k = 0; k < 64; ++k) {
        of[k] = static_cast<uint8_t>(63 - k * n % 64);
        lanes[k * n / 64] |= 1ULL << k;
      }
    }
  };
  static __m128i Least(V a) {
    const __m256i half =
        _mm256_min_epu8(_mm512_castsi512_si256(a.v), _mm512_extracti64x4_epi64(a.v, 1));
    const __m128i quarter =
        _mm_min_epu8(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1));
    return _mm_minpos_epu16(_mm_min_epu8(quarter, _mm_srli_epi16(quarter, 8)));
  }
  alignas(64) static constexpr uint8_t kDown[64] = {
      0,  0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20,
      21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31, 32, 33, 34, 35, 36, 37, 38, 39, 40, 41, 42,
      43, 44, 45, 46, 47, 48, 49, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62};
  alignas(64) static constexpr uint8_t kUp[64] = {
      1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22,
      23, 24, 25, 26, 27, 28, 29, 30, 31, 32, 33, 34, 35, 36, 37, 38, 39, 40, 41, 42, 43, 44,
      45, 46, 47, 48, 49, 50, 51, 52, 53, 54, 55, 56, 57, 58, 59, 60, 61, 62, 63, 63};
};

}  // namespace
