/// \file launcher.cpp  The `quadedge` program of the Python package: runs main() of libquadedge_program.so beside it.
///
/// The libraries of the program, TBB among them, thereby stay out of the global symbol scope. An OpenCL driver that
/// brings another version of TBB, as Intel's does, would otherwise call functions of both.

#include <cstdio>
#include <dlfcn.h>

int main(int argc, char** argv) {
  void* const library = dlopen("libquadedge_program.so", RTLD_NOW | RTLD_LOCAL);  // found by this file's RUNPATH
  void* const function = library == nullptr ? nullptr : dlsym(library, "main");
  if (function == nullptr) {
    std::fprintf(stderr, "quadedge: %s\n", dlerror());
    return 1;
  }
  return reinterpret_cast<int (*)(int, char**)>(function)(argc, argv);
}
