/// \file main.cpp  The quadedge program: runs one command and turns errors into exit codes.
#include <cerrno>
#include <csignal>
#include <exception>
#include <fcntl.h>
#include <filesystem>
#include <iostream>
#include <new>
#include <unistd.h>

#include "cli/console.hpp"
#include "cli/parser.hpp"
#include "quadedge/error.hpp"

namespace {

/// Opens /dev/null in place of closed standard streams, so that no other file gets their descriptors and what is
/// printed. Input is at its end, errors go nowhere, and printing fails as it does into a closed stream.
void occupy_standard_streams() {
  // In this order: open() takes the lowest number that is free. What is open for reading alone cannot be written.
  constexpr struct {
    int stream, mode;
  } kStreams[] = {{STDIN_FILENO, O_RDONLY}, {STDOUT_FILENO, O_RDONLY}, {STDERR_FILENO, O_WRONLY}};
  for (const auto& [stream, mode] : kStreams) {
    if (fcntl(stream, F_GETFD) < 0 && errno == EBADF) open("/dev/null", mode);
  }
}

int end(const std::string& message, quadedge::ExitCode code) {
  quadedge::cli::print_error(message);
  return static_cast<int>(code);
}

}  // namespace

int main(int argc, char** argv) {
  using namespace quadedge;
  occupy_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond `ulimit -f` is a write that fails, like a full disk
  try {
    std::vector<std::unique_ptr<cli::Command>> commands;
    for (const auto make : {cli::make_run_command, cli::make_localise_command, cli::make_demo_command,
                            cli::make_batch_command, cli::make_report_command, cli::make_edges_command,
                            cli::make_match_command, cli::make_evaluate_trajectory_command, cli::make_bench_command,
                            cli::make_compare_command, cli::make_synth_command, cli::make_check_command,
                            cli::make_calibrate_command, cli::make_devices_command, cli::make_variants_command})
      commands.push_back(make());
    const cli::Parsed parsed = cli::parse_command_line(argc, argv, commands);
    if (parsed.command == nullptr) return parsed.exit_code;
    const int code = parsed.command->run();
    std::cout.flush();
    if (!std::cout) throw DataError("standard output cannot be written");
    return code;
  } catch (const Error& error) {
    return end(error.what(), error.exit_code());
  } catch (const std::bad_alloc&) {
    return end("out of memory", ExitCode::internal);
  } catch (const std::filesystem::filesystem_error& error) {
    return end(error.path1().string() + ": " + error.code().message() + "; expected a file or folder that can be read",
               ExitCode::data);
  } catch (const std::exception& error) {
    return end(std::string("internal error: ") + error.what(), ExitCode::internal);
  }
}
