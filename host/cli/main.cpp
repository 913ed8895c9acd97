/// \file main.cpp  The quadedge program: runs one command and turns errors into exit codes.
#include <csignal>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>

#include "cli/parser.hpp"
#include "cli/standard_streams.hpp"
#include "quadedge/error.hpp"

int main(int argc, char** argv) {
  using namespace quadedge;
  cli::occupy_standard_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond `ulimit -f` is a write that fails, like a full disk
  try {
    std::vector<std::unique_ptr<cli::Command>> commands;
    commands.push_back(cli::make_run_command());
    commands.push_back(cli::make_demo_command());
    commands.push_back(cli::make_batch_command());
    commands.push_back(cli::make_report_command());
    commands.push_back(cli::make_edges_command());
    commands.push_back(cli::make_match_command());
    commands.push_back(cli::make_evaluate_trajectory_command());
    commands.push_back(cli::make_evaluate_matching_command());
    commands.push_back(cli::make_bench_command());
    commands.push_back(cli::make_compare_command());
    commands.push_back(cli::make_synth_command());
    commands.push_back(cli::make_check_command());
    commands.push_back(cli::make_devices_command());
    commands.push_back(cli::make_variants_command());
    commands.push_back(cli::make_generate_command(commands));
    const cli::Parsed parsed = cli::parse_command_line(argc, argv, commands);
    if (parsed.command == nullptr) return parsed.exit_code;
    const int code = parsed.command->run();
    std::cout.flush();
    if (!std::cout) throw DataError("standard output cannot be written");
    return code;
  } catch (const Error& error) {
    std::cerr << "quadedge: " << error.what() << "\n";
    return static_cast<int>(error.exit_code());
  } catch (const std::bad_alloc&) {
    std::cerr << "quadedge: out of memory\n";
    return static_cast<int>(ExitCode::internal);
  } catch (const std::filesystem::filesystem_error& error) {
    std::cerr << "quadedge: " << error.path1().string() << ": " << error.code().message()
              << "; expected a place that can be read\n";
    return static_cast<int>(ExitCode::data);
  } catch (const std::exception& error) {
    std::cerr << "quadedge: internal error: " << error.what() << "\n";
    return static_cast<int>(ExitCode::internal);
  }
}
