// visionctl: the command line of VisionServer.

#include <cstdio>
#include <cstdlib>
#include <exception>

#include "client/cli/command_line.h"

int main(int argument_count, char** arguments) {
  // gRPC's own log would say in many lines what an error says in one.
  setenv("GRPC_VERBOSITY", "NONE", 0);
  try {
    vs::cli::CommandLine line;
    AddSessionCommands(line);
    AddSequenceCommands(line);
    AddParameterCommands(line);
    AddDepthCommand(line);
    AddStreamCommands(line);
    AddCameraCommands(line);
    AddResultCommands(line);
    AddUserCommands(line);
    AddKeyCommands(line);
    AddAuditCommand(line);
    AddStatusCommand(line);
    return line.Main(argument_count, arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "visionctl: %s\n", error.what());
    return vs::cli::kExitFailure;
  }
}
