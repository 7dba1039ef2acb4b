"""Unpacks RVL, the lossless packing of depth images described in proto/wire/rvl.h."""

import array


def decode(packed, pixels):
    """The given number of uint16 values as an array; ValueError unless `packed` is exactly that."""
    values = array.array("H", bytes(2 * pixels))
    nibbles = _nibbles(packed)
    index = 0
    previous = 0
    try:
        while index < pixels:
            zeroes = _number(nibbles)
            index += zeroes
            count = _number(nibbles)
            if index + count > pixels or zeroes + count == 0:
                raise ValueError("a run is empty or longer than the pixels that are left")
            for index in range(index, index + count):
                zigzag = _number(nibbles)
                previous += (zigzag >> 1) ^ -(zigzag & 1)
                if not 0 < previous < 65536:
                    raise ValueError("a value is out of range")
                values[index] = previous
            index += 1 if count else 0
    except StopIteration:
        raise ValueError("the packed bytes end before the last pixel") from None
    rest = list(nibbles)
    if len(rest) > 7 or any(rest):
        raise ValueError("bytes follow the last pixel")
    return values


def _nibbles(packed):
    """Of each little-endian 32-bit word the highest first."""
    if len(packed) % 4:
        raise ValueError("the packed bytes are no whole words")
    for start in range(0, len(packed), 4):
        word = int.from_bytes(packed[start:start + 4], "little")
        for shift in range(28, -1, -4):
            yield word >> shift & 15


def _number(nibbles):
    """Three bits in each nibble, the lowest first; the fourth says that more follow."""
    number = 0
    for shift in range(0, 33, 3):
        nibble = next(nibbles)
        number |= (nibble & 7) << shift
        if nibble < 8:
            return number
    raise ValueError("a number has no end")
