# Writes one C++ source that holds the commit the program is built from, with a "+" where the tree has changes beyond
# it; empty outside a checkout. In: FOLDER (of the sources), OUTPUT. The file keeps its time stamp when nothing changed.
set(commit "")
find_program(git_program git)
if(git_program AND EXISTS ${FOLDER}/.git)
  execute_process(COMMAND ${git_program} describe --always --dirty=+ --abbrev=12 --exclude=* WORKING_DIRECTORY ${FOLDER}
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
set(text "// Generated; do not edit.\n
namespace quadedge::report {
const char* source_commit();
const char* source_commit() { return \"${commit}\"; }\n}  // namespace quadedge::report\n")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} before)
endif()
if(NOT "${before}" STREQUAL "${text}")
  file(WRITE ${OUTPUT} "${text}")
endif()
