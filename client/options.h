#pragma once

#include <chrono>
#include <string>

namespace vs::client {

// How to reach a server and how to know that it is the right one.
//
// A server's certificate is trusted in one of three ways:
//  - `fingerprint`: exactly this certificate, however it is signed. The server prints it when it
//    starts; carry it over by a way you trust.
//  - `ca_file`: what this certificate (or one that it signed) says, for the name in `address`. For
//    a server that made its own certificate this is its file "server.crt".
//  - neither: the authorities that this system trusts, for the name in `address`.
// Nothing is trusted because it was met first.
struct ConnectOptions {
  std::string address = "localhost:50051";  // HOST, HOST:PORT or [IPV6]:PORT
  std::string ca_file;                      // PEM
  std::string fingerprint;                  // SHA-256, 64 hexadecimal digits, colons optional
  // No TLS at all. Only to this machine itself, and only to a server that was started so.
  bool plaintext = false;
  // Token of an earlier login, or a robot's API key. Empty: call Login, or only what works without.
  std::string credential;
  // How the server's list of sessions names this client.
  std::string client_name = "C++ client";
  std::chrono::milliseconds connect_timeout{5000};
  // Of calls that answer once.
  std::chrono::milliseconds call_timeout{15'000};
  // A quiet connection is checked so often; one that is dead is noticed after this and half of it.
  // Servers allow 5 s and more unless configured otherwise.
  std::chrono::milliseconds keepalive{10'000};
};

}  // namespace vs::client
