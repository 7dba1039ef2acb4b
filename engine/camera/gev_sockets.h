#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/mutex.h"

namespace vs {

// The UDP sockets of this process, looked at from outside: Aravis does not tell which ones are its
// own, and they are needed where it has no function for what is to be done.

struct UdpSocket {
  int fd = -1;
  ino_t inode = 0;      // tells it from a later socket with the same `fd`
  std::string address;  // the local one; 0.0.0.0 for all
  uint16_t port = 0;

  bool operator==(const UdpSocket&) const = default;
};

std::vector<UdpSocket> UdpSocketsOfThisProcess();

// Puts a socket that leads nowhere in its place: who sends gets an error at once, and nothing comes
// any more. Its owner closes it as usual. It must not be closed meanwhile.
void Silence(const UdpSocket& socket);

// Held wherever Aravis opens sockets that stay, so that the new ones are known to be of that call.
Mutex& AravisOpensSockets();

}  // namespace vs
