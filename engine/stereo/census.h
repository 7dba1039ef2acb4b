#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/stereo/padded_picture.h"
#include "engine/stereo/sgm_settings.h"

namespace vs {

// A census code says which neighbours of a pixel are darker than the pixel itself (Zabih, Woodfill
// 1994); the distance of two codes is the number of bits in which they differ. A code is held as
// bytes of 8 neighbours each, unused bits 0; the order of the bits does not matter.

// Bytes of a code: 3 for the patterns of 24 bits, 6 for 7x7, 8 for 9x7.
int CensusBytes(CensusPattern pattern);

// How far the distance is shifted right, rounding up, to become a cost: 1 for 7x7 and 9x7, else 0.
// So every pattern's largest cost is 24, or 31 for 9x7, and p1 and p2 keep their meaning.
int CensusShift(CensusPattern pattern);

// The neighbours of a pattern in the order of their bits, as steps in memory from the centre in a
// picture with this many bytes from row to row. Returns how many there are; at most 62.
int CensusSteps(CensusPattern pattern, ptrdiff_t stride, ptrdiff_t* steps);

// The codes of row `y`: byte b of pixel x goes to codes[b * width + x].
void CensusRow(const PaddedPicture& picture, CensusPattern pattern, int y, uint8_t* codes);

}  // namespace vs
