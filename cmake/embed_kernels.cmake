# Writes one C++ source that holds the text of every kernel file, so that the program carries its kernels with it. In:
# FILES (list of .cl paths), OUTPUT. A #line marker in front of each text makes compiler messages name file and line.
set(body "")
foreach(file IN LISTS FILES)
  get_filename_component(name ${file} NAME)
  file(READ ${file} text)
  # Compilers limit one string literal to 64 KiB; pieces of 8 KiB are joined by the compiler.
  set(pieces "")
  string(LENGTH "${text}" length)
  set(position 0)
  while(position LESS length)
    string(SUBSTRING "${text}" ${position} 8192 piece)
    string(APPEND pieces "R\"kernel(${piece})kernel\"\n")
    math(EXPR position "${position} + 8192")
  endwhile()
  string(APPEND body "    {\"${name}\", \"#line 1 \\\"${name}\\\"\\n\"\n${pieces}},\n")
endforeach()
file(WRITE ${OUTPUT} "// Generated from kernels/*.cl; do not edit.\n#include \"device/kernel_sources.hpp\"\n
namespace quadedge::opencl {
const std::map<std::string, std::string>& embedded_kernels() {
  static const std::map<std::string, std::string> sources = {
${body}  };
  return sources;
}
}  // namespace quadedge::opencl
")
