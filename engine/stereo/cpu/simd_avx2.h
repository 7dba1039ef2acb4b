#pragma once

#include <immintrin.h>

#include <cstddef>
#include <cstdint>

namespace {

// 32 bytes side by side on AVX2; simd_portable.h says what each name means.
struct Simd {
  static constexpr int kLanes = 32;
  static constexpr int kRegisters = 16;
  struct V {
    __m256i v;
  };

  static V Load(const uint8_t* p) {
    return {_mm256_load_si256(reinterpret_cast<const __m256i*>(p))};
  }
  static V LoadAnywhere(const uint8_t* p) {
    return {_mm256_loadu_si256(reinterpret_cast<const __m256i*>(p))};
  }
  static void Store(uint8_t* p, V a) { _mm256_store_si256(reinterpret_cast<__m256i*>(p), a.v); }
  static void StoreAnywhere(uint8_t* p, V a) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), a.v);
  }
  static void Stream(uint8_t* p, V a) { _mm256_stream_si256(reinterpret_cast<__m256i*>(p), a.v); }
  static void EndStream() { _mm_sfence(); }
  static V Set(uint8_t a) { return {_mm256_set1_epi8(static_cast<char>(a))}; }
  template <int n>
  static V EveryNth(const uint8_t* last) {
    alignas(32) uint8_t a[kLanes];
    for (int k = 0; k < kLanes; ++k) a[k] = last[-ptrdiff_t{k} * n];
    return Load(a);
  }

  static V Min(V a, V b) { return {_mm256_min_epu8(a.v, b.v)}; }
  static V Max(V a, V b) { return {_mm256_max_epu8(a.v, b.v)}; }
  static V Add(V a, V b) { return {_mm256_add_epi8(a.v, b.v)}; }
  static V AddSaturated(V a, V b) { return {_mm256_adds_epu8(a.v, b.v)}; }
  static V Subtract(V a, V b) { return {_mm256_sub_epi8(a.v, b.v)}; }
  static V SubtractSaturated(V a, V b) { return {_mm256_subs_epu8(a.v, b.v)}; }
  static V Magnitude(V a) { return {_mm256_abs_epi8(a.v)}; }
  static V Average(V a, V b) { return {_mm256_avg_epu8(a.v, b.v)}; }
  static V Xor(V a, V b) { return {_mm256_xor_si256(a.v, b.v)}; }
  static V Or(V a, V b) { return {_mm256_or_si256(a.v, b.v)}; }
  static V BitCount(V a) {
    return CountBy(_mm256_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4, 0, 1, 1, 2, 1,
                                    2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4),
                   a);
  }
  // A full adder for each bit: two counts, of its sums and, twice, of its carries.
  static V BitCountOfThree(V a, V b, V c) {
    const V ab = Xor(a, b);
    const V carry = {_mm256_or_si256(_mm256_and_si256(a.v, b.v), _mm256_and_si256(ab.v, c.v))};
    return Add(BitCount(Xor(ab, c)),
               CountBy(_mm256_setr_epi8(0, 2, 2, 4, 2, 4, 4, 6, 2, 4, 4, 6, 4, 6, 6, 8, 0, 2, 2, 4,
                                        2, 4, 4, 6, 2, 4, 4, 6, 4, 6, 6, 8),
                       carry));
  }

  static V IfEqual(V a, V b, V yes, V no) {
    return {_mm256_blendv_epi8(no.v, yes.v, _mm256_cmpeq_epi8(a.v, b.v))};
  }
  static V IfLess(V a, V b, V yes, V no) {
    const __m256i not_less = _mm256_cmpeq_epi8(_mm256_max_epu8(a.v, b.v), a.v);
    return {_mm256_blendv_epi8(yes.v, no.v, not_less)};
  }

  // With the comparison that the minimum has made already.
  static void TakeLess(V a, V of_a, V* least, V* index) {
    const V less = Min(a, *least);
    index->v = _mm256_blendv_epi8(of_a.v, index->v, _mm256_cmpeq_epi8(less.v, least->v));
    *least = less;
  }
  static void TakeLeast(V a, V of_a, V* least, V* index) {
    *least = Min(a, *least);
    index->v = _mm256_blendv_epi8(index->v, of_a.v, _mm256_cmpeq_epi8(least->v, a.v));
  }
  using Exception = uint8_t;  // the lane
  static constexpr Exception kNoException = 255;
  static constexpr Exception Except(int lane) { return static_cast<Exception>(lane); }
  static V MinBut(V a, V b, Exception lane) {
    const __m256i numbers =
        _mm256_setr_epi8(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20,
                         21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 31);
    const __m256i excepted = _mm256_cmpeq_epi8(numbers, Set(lane).v);
    return {_mm256_min_epu8(a.v, _mm256_or_si256(b.v, excepted))};
  }

  static V FromBelow(V a, uint8_t guard) {
    return {_mm256_alignr_epi8(a.v, _mm256_permute2x128_si256(a.v, Set(guard).v, 0x02), 15)};
  }
  static V FromAbove(V a, uint8_t guard) {
    return {_mm256_alignr_epi8(_mm256_permute2x128_si256(a.v, Set(guard).v, 0x21), a.v, 1)};
  }

  static V LeastOfAll(V a) { return {_mm256_broadcastb_epi8(Least(a))}; }
  static uint8_t LeastByte(V a) { return static_cast<uint8_t>(_mm_cvtsi128_si32(Least(a))); }
  // Pairs: sixteen bits each, the first argument above the second.
  static V PairLow(V high, V low) { return {_mm256_unpacklo_epi8(low.v, high.v)}; }
  static V PairHigh(V high, V low) { return {_mm256_unpackhi_epi8(low.v, high.v)}; }
  static V MinPairs(V a, V b) { return {_mm256_min_epu16(a.v, b.v)}; }
  static int LeastPair(V a) {
    const __m128i half =
        _mm_min_epu16(_mm256_castsi256_si128(a.v), _mm256_extracti128_si256(a.v, 1));
    return _mm_cvtsi128_si32(_mm_minpos_epu16(half)) & 0xffff;
  }
  static uint64_t ZeroLanes(V a) {
    return static_cast<uint32_t>(
        _mm256_movemask_epi8(_mm256_cmpeq_epi8(a.v, _mm256_setzero_si256())));
  }
  static uint8_t First(V a) {
    return static_cast<uint8_t>(_mm_cvtsi128_si32(_mm256_castsi256_si128(a.v)));
  }
  static uint8_t Last(V a) { return static_cast<uint8_t>(_mm256_extract_epi8(a.v, 31)); }

 private:
  // The sum of what a table says of both halves of each byte.
  static V CountBy(__m256i table, V a) {
    const __m256i low = _mm256_set1_epi8(15);
    return {_mm256_add_epi8(
        _mm256_shuffle_epi8(table, _mm256_and_si256(a.v, low)),
        _mm256_shuffle_epi8(table, _mm256_and_si256(_mm256_srli_epi16(a.v, 4), low)))};
  }
  static __m128i Least(V a) {
    const __m128i half =
        _mm_min_epu8(_mm256_castsi256_si128(a.v), _mm256_extracti128_si256(a.v, 1));
    return _mm_minpos_epu16(_mm_min_epu8(half, _mm_srli_epi16(half, 8)));
  }
};

}  // namespace
