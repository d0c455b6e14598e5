// Scripts that a user runs: each says how, and does nothing else when asked that.
#include "support/files.h"
#include "support/program.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace scripts_tests
{
using namespace antiform::test;
namespace fs = std::filesystem;

namespace
{
/// Runs every script below the folders of the source with --help, in one process: each
/// would load numpy and matplotlib anew. What a script has loaded from its own folder is
/// forgotten, since others have files of the same names.
const char *const ask_all = R"(import contextlib, glob, io, os, runpy, sys
source = sys.argv[1]
scripts = [path for folder in ("cases", "docs")
           for path in sorted(glob.glob(f"{source}/{folder}/**/*.py", recursive=True))
           if "__main__" in open(path).read()]
before = list(sys.path)
for path in scripts:
    sys.argv, sys.path = [path, "--help"], [os.path.dirname(path)] + before
    said, status = io.StringIO(), None
    with contextlib.redirect_stdout(said):
        try:
            runpy.run_path(path, run_name="__main__")
        except SystemExit as end:
            status = end.code
    if status not in (0, None) or not said.getvalue().startswith("usage: "):
        print(f"{path}: status {status}, says '{said.getvalue()[:200]}'")
    for name, module in list(sys.modules.items()):
        if str(getattr(module, "__file__", "")).startswith(source):
            del sys.modules[name]
if "matplotlib.pyplot" in sys.modules and sys.modules["matplotlib.pyplot"].get_fignums():
    print("a picture was drawn")
print(len(scripts), "scripts")
)";
} // namespace

TEST(Scripts, SayHowTheyAreRun)
{
  const TemporaryFolder folder;
  std::ofstream(folder.path("ask.py")) << ask_all;
  fs::create_directories(folder.path("empty"));
  const Outcome outcome = run_command(
      "cd " + folder.path("empty") + " && MPLCONFIGDIR=" + folder.path("matplotlib") +
      " /usr/bin/python3 -B ../ask.py " ANTIFORM_SOURCE_DIR);
  EXPECT_EQ(outcome.status, 0);
  // Nothing but the last line: more than twenty of them, and none has failed.
  EXPECT_EQ(occurrences(outcome.output, "\n"), 1u) << outcome.output;
  EXPECT_GT(std::stoi(outcome.output), 20) << outcome.output;
  EXPECT_TRUE(fs::is_empty(folder.path("empty")));
}
} // namespace scripts_tests
