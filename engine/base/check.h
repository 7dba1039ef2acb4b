#pragma once

#include <stdexcept>

namespace vs {

// Thrown by VS_CHECK. The runner turns it into the failure of one block, the server into INTERNAL:
// a bug of ours fails the sequence, not the process.
class BrokenInvariant : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

}  // namespace vs

#define VS_CHECK_TEXT_INNER_(x) #x
#define VS_CHECK_TEXT_(x) VS_CHECK_TEXT_INNER_(x)

// Guards against our own bugs, never against input.
#define VS_CHECK(condition)                                                                       \
  do {                                                                                            \
    if (!(condition)) {                                                                           \
      throw ::vs::BrokenInvariant(__FILE__ ":" VS_CHECK_TEXT_(__LINE__) ": broken: " #condition); \
    }                                                                                             \
  } while (false)
