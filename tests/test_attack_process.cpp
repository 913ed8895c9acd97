/// \file test_attack_process.cpp  Attacks on the environment of the process. A row holds a shell command that runs the
/// program ($QUADEDGE) while something is missing, closed or full, and the expected outcome. To add an attack, add a
/// row.

#include <catch2/catch.hpp>
#include <sys/wait.h>

#include "program.hpp"

using Catch::Matchers::Contains;

namespace {

struct ProcessAttack {
  std::string name, command;  ///< $QUADEDGE, $DATA: a small recording, $OUT: a folder that does not exist yet
  int code;
  std::string words;        ///< expected on standard error; empty: nothing expected
  bool has_results = true;  ///< whether the run's results are in $OUT
};

const std::vector<ProcessAttack> kProcessAttacks = {
    {"standard output is closed", "$QUADEDGE run $DATA -o $OUT --frames 0:2 --quiet >&-", 3, "standard output"},
    {"standard error is closed", "$QUADEDGE run $DATA -o $OUT --frames 0:2 2>&-", 0, ""},
    {"all streams are closed", "$QUADEDGE run $DATA -o $OUT --frames 0:2 --quiet <&- >&- 2>&-", 3, ""},
    {"standard output is a full disk", "$QUADEDGE devices >/dev/full", 3, "standard output", false},
    {"standard error is a full disk", "$QUADEDGE run $DATA -o $OUT --frames 0:2 2>/dev/full", 0, ""},
    {"results go to a full disk", "$QUADEDGE edges $DATA/rgb/0.000000000.png --csv /dev/full --force", 3, "/dev/full",
     false},
    {"results go into a file", "touch $OUT; $QUADEDGE run $DATA -o $OUT", 3, "Not a directory", false},
    {"results go to an impossible folder", "$QUADEDGE run $DATA -o /dev/null/out", 3, "/dev/null", false},
    {"the size of files is limited", "ulimit -f 1; $QUADEDGE run $DATA -o $OUT --frames 0:2", 3, "", false},
    {"there is no home folder", "unset HOME; $QUADEDGE run $DATA -o $OUT --frames 0:2 --quiet", 0, ""},
    {"there is no cache folder", "XDG_CACHE_HOME=/dev/null/cache $QUADEDGE run $DATA -o $OUT --frames 0:2 --quiet", 0,
     ""},
    {"there is no configuration folder",
     "XDG_CONFIG_HOME=/dev/null/config $QUADEDGE run $DATA -o $OUT --frames 0:2 --quiet", 0, ""},
    {"the working folder is deleted",
     "mkdir $OUT.gone && cd $OUT.gone && rmdir $OUT.gone && $QUADEDGE run $DATA -o $OUT --frames 0:2 --quiet", 0, ""},
    {"the language is unknown", "LC_ALL=tlh_KX.UTF-8 $QUADEDGE run $DATA -o $OUT --frames 0:2 --quiet", 0, ""},
    {"commas separate decimals", "LC_ALL=de_DE.UTF-8 $QUADEDGE run $DATA -o $OUT --frames 0:2 --quiet", 0, ""},
    {"the device is unknown", "QUADEDGE_DEVICE=abacus $QUADEDGE run $DATA -o $OUT --frames 0:2", 4, "abacus", false},
    {"the search path is empty", "PATH= ; $QUADEDGE run $DATA -o $OUT --frames 0:2 --quiet", 0, ""},
};

}  // namespace

TEST_CASE("attack: in any environment the program does its work or explains why not", "[cli][device]") {
  for (const auto& attack : kProcessAttacks) {
    DYNAMIC_SECTION(attack.name) {
      const TemporaryFolder folder;
      const std::string settings =
          "QUADEDGE='" + program_path() + "' DATA='" + small_sequence() + "' OUT='" + (folder / "out") + "' ";
      const std::string command = environment_of_tests() + " " + settings + "sh -c '" + attack.command + "' >'" +
                                  (folder / "stdout") + "' 2>'" + (folder / "stderr") + "' </dev/null";
      const int status = std::system(command.c_str());
      const std::string error = read_text(folder / "stderr");
      INFO(error);
      REQUIRE(WIFEXITED(status));
      CHECK(WEXITSTATUS(status) == attack.code);
      CHECK_THAT(error, Contains(attack.words) && !Contains("internal"));
      if (attack.has_results) CHECK(read_lines(folder / "out/trajectory.txt").size() == 3);  // including the comment
    }
  }
}
