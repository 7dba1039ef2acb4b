#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace vs::wire {

// The variable-length numbers of RVL (see rvl.h). Nearly all numbers of a real map are small, so
// those of up to three nibbles go through tables.

// The nibbles of a number, the first one highest.
struct NibbleCode {
  uint16_t nibbles;
  uint16_t bits;
};

// Codes of the numbers below 512 = 8^3.
inline constexpr auto kNibbleCodes = [] {
  std::array<NibbleCode, 512> codes{};
  for (uint32_t number = 0; number < codes.size(); ++number) {
    NibbleCode code{0, 0};
    for (uint32_t rest = number, more = 1; more != 0; rest >>= 3) {
      more = rest >> 3 != 0 ? 8 : 0;
      code.nibbles = static_cast<uint16_t>(code.nibbles << 4 | (rest & 7) | more);
      code.bits += 4;
    }
    codes[number] = code;
  }
  return codes;
}();

// What the next three nibbles begin with: a whole number, or bits == 0 when it is longer.
struct NibbleNumber {
  uint16_t number;
  uint16_t bits;
};

inline constexpr auto kNibbleNumbers = [] {
  std::array<NibbleNumber, 4096> numbers{};
  for (uint32_t number = 0; number < kNibbleCodes.size(); ++number) {
    const NibbleCode code = kNibbleCodes[number];
    const int spare_bits = 12 - code.bits;
    for (uint32_t tail = 0; tail < 1U << spare_bits; ++tail) {
      numbers[(static_cast<uint32_t>(code.nibbles) << spare_bits) | tail] = {
          static_cast<uint16_t>(number), code.bits};
    }
  }
  return numbers;
}();

// Turns a word as it lies in memory on the wire into one of this machine, and back.
inline uint32_t LittleEndian(uint32_t word) {
  if constexpr (std::endian::native == std::endian::big) word = __builtin_bswap32(word);
  return word;
}

// Writes up to four bytes beyond what it returns at the end; the caller gives it that room.
class NibbleWriter {
 public:
  explicit NibbleWriter(uint8_t* out) : out_(out) {}

  void Put(uint32_t number) {
    if (number < kNibbleCodes.size()) {
      Append(kNibbleCodes[number].nibbles, kNibbleCodes[number].bits);
      return;
    }
    for (; number > 7; number >>= 3) Append((number & 7) | 8, 4);
    Append(number, 4);
  }

  // The same as one after the other, in one step when both are short: each step waits for the one
  // before, and this halves their number.
  void PutTwo(uint32_t first, uint32_t second) {
    if ((first | second) < kNibbleCodes.size()) {
      const NibbleCode a = kNibbleCodes[first];
      const NibbleCode b = kNibbleCodes[second];
      Append(static_cast<uint64_t>(a.nibbles) << b.bits | b.nibbles, a.bits + b.bits);
      return;
    }
    Put(first);
    Put(second);
  }

  // Fills the last word and returns where the packed bytes end.
  uint8_t* Finish() {
    if (used_bits_ == 0) return out_;
    Store();
    return out_ + 4;
  }

 private:
  void Append(uint64_t nibbles, int bits) {
    word_ = word_ << bits | nibbles;
    used_bits_ += bits;
    // Stored each time and counted only when full: no branch to mispredict.
    Store();
    out_ += used_bits_ >= 32 ? 4 : 0;
    used_bits_ %= 32;
  }

  void Store() {
    const auto top = static_cast<uint32_t>(word_ << (64 - used_bits_) >> 32);
    const uint32_t word = LittleEndian(top);
    std::memcpy(out_, &word, sizeof(word));
  }

  uint8_t* out_;
  uint64_t word_ = 0;
  int used_bits_ = 0;
};

// Reads whole words only; a number beyond the end is not there.
class NibbleReader {
 public:
  // size_bytes must be a multiple of 4.
  NibbleReader(const uint8_t* in, size_t size_bytes) : in_(in), end_(in + size_bytes) {}

  // False when the bytes are at their end, or the number has more than 32 bits.
  bool Get(uint32_t* number) {
    Refill();
    const NibbleNumber entry = kNibbleNumbers[window_ >> 52];
    if (entry.bits == 0) return GetLong(number);
    *number = entry.number;
    return Drop(entry.bits);
  }

  // Whether nothing but the filling of the last word is left.
  bool AtEnd() const { return in_ == end_ && left_bits_ < 32 && window_ == 0; }

 private:
  // At least 33 bits, unless the bytes end before.
  void Refill() {
    if (left_bits_ > 32 || in_ == end_) return;
    uint32_t word = 0;
    std::memcpy(&word, in_, sizeof(word));
    window_ |= static_cast<uint64_t>(LittleEndian(word)) << (32 - left_bits_);
    left_bits_ += 32;
    in_ += 4;
  }

  bool Drop(int bits) {
    window_ <<= bits;
    left_bits_ -= bits;
    return left_bits_ >= 0;
  }

  bool GetLong(uint32_t* number) {
    uint64_t sum = 0;
    for (int shift = 0; shift < 33; shift += 3) {
      Refill();
      const uint64_t nibble = window_ >> 60;
      if (!Drop(4)) return false;
      sum |= (nibble & 7) << shift;
      if ((nibble & 8) == 0) {
        *number = static_cast<uint32_t>(sum);
        return sum <= UINT32_MAX;
      }
    }
    return false;
  }

  const uint8_t* in_;
  const uint8_t* end_;
  uint64_t window_ = 0;  // the next bits, from the highest down; zero below them
  int left_bits_ = 0;    // how many of them
};

}  // namespace vs::wire
