/// \file write_self_test.cpp  Writes the data of the self-test.
///   write_self_test FILE

#include <fstream>

#include "self_test_now.hpp"

int main(int, char** arguments) {
  const std::string bytes = quadedge::frontend::bytes_of(self_test_now());
  return std::ofstream(arguments[1], std::ios::binary).write(bytes.data(), static_cast<long>(bytes.size())) ? 0 : 1;
}
