/// \file test_attack_process.cpp  Attacks on the environment of the process. A row holds a shell command that runs the
/// program ($QUADEDGE) while something is missing, closed or full, and the expected outcome. To add an attack, add a
/// row.

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
    {"standard output is a full disk", "$QUADEDGE devices >/dev/full", 3, "standard output", false},
    {"standard error is a full disk", "$QUADEDGE run $DATA -o $OUT --frames 0:2 2>/dev/full", 0, ""},
    {"results go to a full disk", "$QUADEDGE edges $DATA/rgb/0.000000000.png --csv /dev/full --force", 3, "/dev/full",
     false},
    {"the map goes to a full disk, and the results do not",
     "$QUADEDGE run $DATA -o $OUT --frames 0:2 --save-map /dev/full --force && exit 99; code=$?; "
     "grep -q frames_tracked $OUT/report.json || exit 98; exit $code",
     3, "/dev/full"},
    {"results go into a file", "touch $OUT; $QUADEDGE run $DATA -o $OUT", 3, "Not a directory", false},
    {"results go to an impossible folder", "$QUADEDGE run $DATA -o /dev/null/out", 3, "/dev/null", false},
    {"the size of files is limited, and the driver writes its kernels",
     "mkdir $OUT.cache; ulimit -f 1; POCL_CACHE_DIR=$OUT.cache $QUADEDGE run $DATA -o $OUT --frames 0:2", 4,
     "ulimit -f", false},
    {"the size of files is limited", "ulimit -f 2; $QUADEDGE run $DATA -o $OUT --frames 0:2 --device reference", 3,
     "out/config.toml", false},
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
    {"the cache folder of the driver is not writable",
     "POCL_CACHE_DIR=/dev/null/cache $QUADEDGE run $DATA -o $OUT --frames 0:2 --quiet", 4, "POCL_CACHE_DIR", false},
    {"a mask is an empty word", "$QUADEDGE run $DATA -o $OUT --mask \"\"", 2, "--mask: expected a value", false},
    {"a configuration is an empty word", "$QUADEDGE run $DATA -o $OUT --config \"\"", 2, "--config: expected a value",
     false},
    {"an output is an empty word", "$QUADEDGE synth \"\" --frames 2", 2, "OUT: expected a value", false},
    {"a comparison is with an empty word", "$QUADEDGE bench --compare \"\" \"\"", 2, "expected a value", false},
    {"results go to a symbolic link, which stays",
     "touch $OUT.csv; ln -s $OUT.csv $OUT.link; $QUADEDGE edges $DATA/rgb/0.000000000.png --csv $OUT.link --force "
     "--quiet && test -L $OUT.link && test -s $OUT.csv",
     0, "", false},
    {"an image is sparse and larger than the memory",
     "truncate -s 40G $OUT.png; $QUADEDGE edges $OUT.png --csv $OUT.csv", 3, "out.png: found 42949672960 bytes", false},
    {"a pipe announces more than the memory holds",
     "$QUADEDGE check $DATA --write-calibration $OUT.yaml >$OUT.log; ulimit -v 6000000; printf \"P5 65535 65535 65535 "
     "\" | "
     "$QUADEDGE run - --fps 20 --calibration $OUT.yaml -o $OUT",
     3, "image 0 that ends after 0 of 8589672450 bytes", false},
    {"an image is damaged and the map goes to a full disk",
     "cp -r $DATA $OUT.data; echo > $OUT.data/rgb2/0.100000000.png; $QUADEDGE run $OUT.data -o $OUT --points /dev/full "
     "--force",
     3, "2 finished frames in", true},
    {"an image is damaged while frames are located",
     "$QUADEDGE run $DATA -o $OUT.run --save-map $OUT.map --quiet >$OUT.log; cp -r $DATA $OUT.data; echo > "
     "$OUT.data/rgb2/0.100000000.png; $QUADEDGE localise $OUT.map $OUT.data -o $OUT --quiet",
     3, "2 finished frames in", true},
    {"two outputs are one file", "$QUADEDGE run $DATA -o $OUT --save-map $OUT.x --points $OUT.x", 2,
     "out.x: two outputs would be written", false},
    {"two outputs are one file under two names",
     "touch $OUT.a; ln $OUT.a $OUT.b; ln -s $OUT.b $OUT.c; $QUADEDGE edges $DATA/rgb/0.000000000.png --csv $OUT.a "
     "--draw "
     "$OUT.c --force",
     2, "two outputs would be written to this file", false},
    {"two outputs are one device", "$QUADEDGE edges $DATA/rgb/0.000000000.png --csv /dev/null --draw /dev/null --quiet",
     0, "", false},
    {"an output is an input",
     "cp $DATA/rgb/0.000000000.png $OUT.png; $QUADEDGE edges $OUT.png --draw $OUT.png --force; code=$?; cmp $OUT.png "
     "$DATA/rgb/0.000000000.png || exit 99; exit $code",
     2, "out.png: an output would replace this file, which is read", false},
    {"an output is the configuration",
     "echo seed = 3 >$OUT.toml; $QUADEDGE run $DATA -o $OUT --config $OUT.toml --points $OUT.toml --force", 2,
     "out.toml: an output would replace this file", false},
    {"an output is one of the files of the run", "$QUADEDGE run $DATA -o $OUT --save-map $OUT/./frames.csv", 2,
     "frames.csv: the run writes its own results", false},
    {"an output lies among the pictures of the run", "$QUADEDGE run $DATA -o $OUT --points $OUT/pictures/points.ply", 2,
     "points.ply: the run writes its own results", false},
    {"an output beside the files of the run is fine",
     "$QUADEDGE run $DATA -o $OUT --frames 0:2 --quiet --points $OUT/points.ply", 0, ""},
    {"an output is an image of the recording",
     "cp -r $DATA $OUT.data; $QUADEDGE run $OUT.data -o $OUT --force --points $OUT.data/rgb/0.000000000.png", 2,
     "0.000000000.png: this file belongs to the recording", false},
    {"the results go among the files of the recording",
     "cp -r $DATA $OUT.data; $QUADEDGE run $OUT.data -o $OUT.data --force; code=$?; test -s $OUT.data/groundtruth.txt "
     "|| "
     "exit 99; exit $code",
     2, "out.data: the results would be written among the files of the recording", false},
    {"an output is a symbolic link to nothing, which stays",
     "ln -s $OUT.nothing $OUT.csv; $QUADEDGE edges $DATA/rgb/0.000000000.png --csv $OUT.csv --force; code=$?; test -L "
     "$OUT.csv || exit 99; exit $code",
     3, "out.csv: cannot follow the symbolic link", false},
    {"the name of a file has control characters",
     "$QUADEDGE check \"$(printf \"a\\033[2Jb\\302\\233c\")\"; code=$?; exit $code", 3, "a\\x1b[2Jb\\x9bc", false},
    {"a standard deviation is nearly zero", "$QUADEDGE run $DATA -o $OUT --pose.disparity_offset_sigma 1e-160", 2,
     "pose.disparity_offset_sigma is 1e-160; allowed: 0, and magnitudes of at least 1e-09", false},
    {"times go back",
     "$QUADEDGE check $DATA --write-calibration $OUT.yaml >$OUT.log; printf \"0\\n2\\n1\\n3\\n\" >$OUT.txt; $QUADEDGE "
     "run "
     "--left $DATA/rgb --right $DATA/rgb2 --times $OUT.txt --calibration $OUT.yaml -o $OUT",
     3, "out.txt:3: found timestamp 1.000000000 after 2.000000000", false},
    {"folders are nested 1500 deep",
     "d=$OUT; for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15; do for j in 0 1 2 3 4 5 6 7 8 9; do "
     "d=$d/a/a/a/a/a/a/a/a/a/a; done; done; mkdir -p $d; ulimit -t 20; $QUADEDGE check $OUT",
     3, "", false},
    {"the program is told to end while a page is made",
     "$QUADEDGE run $DATA -o $OUT --frames 0:2 --quiet; printf \"#!/bin/sh\\n[ \\$1 = -c ] || { echo \\$\\$ >$OUT.pid; "
     "exec sleep "
     "60; }\\n\" >$OUT.py; chmod +x $OUT.py; QUADEDGE_PYTHON=$OUT.py $QUADEDGE report $OUT & pid=$!; "
     "while [ ! -s $OUT.pid ]; do sleep 0.1; done; kill -TERM $pid; wait $pid; code=$?; kill -0 $(cat $OUT.pid) "
     "2>$OUT.log "
     "&& exit 99; exit $code",
     143, "interrupted; no page was made"},
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
