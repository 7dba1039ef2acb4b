#pragma once

#include <cstdint>

namespace vs::sim {

// Mixes the bits of a number, so that neighbours give unrelated values (splitmix64's finaliser,
// Steele et al. 2014).
inline uint64_t Hash(uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace vs::sim
