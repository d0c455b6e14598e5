#include "cases/command_line.h"

#include <CLI/CLI.hpp>

#include <sstream>

namespace antiform::cases
{
namespace
{
void add_deck(CLI::App &command, RunOptions &run)
{
  command.add_option("DECK", run.deck, "parameter file (.prm)")->required();
  command
      .add_option(
          "--set", run.overrides,
          "\"Section/Entry=value\": overrides the deck; of two for one entry the last "
          "counts")
      ->expected(1)
      ->take_all()
      ->allow_extra_args(false)
      ->type_name("ENTRY=VALUE");
}

void add_output(CLI::App &command, RunOptions &run)
{
  command.add_option("-o,--output", run.output, "output directory (DECK-output)")
      ->check([](const std::string &text)
              { return text.empty() ? "give a directory" : ""; })
      ->type_name("DIR");
}

void add_threads(CLI::App &command,
                 RunOptions &run,
                 const std::string &what = "threads of each rank (OMP_NUM_THREADS)")
{
  command.add_option("--threads", run.threads, what)
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
}

void add_run(CLI::App &app, CommandLine &line)
{
  CLI::App &command = *app.add_subcommand("run", "run a deck");
  add_deck(command, line.run);
  add_output(command, line.run);
  add_threads(command, line.run);
  command.add_flag("--resume", line.run.resume,
                   "go on from state.h5 in the output directory");
  command
      .add_option("--time-limit", line.run.time_limit,
                  "stop after so many seconds (exit status 3), with a checkpoint if the "
                  "driver steps in time")
      ->check(CLI::Range(1e-9, 1e12)) // not NaN either
      ->type_name("SECONDS");
  command.footer(
      "Example:\n  antiform run cases/burial-depth/quick.prm -o out "
      "--set \"Matrix/Burial depth ratio=5\"\n"
      "  antiform run cases/burial-depth/anticline.prm --threads 2 --time-limit 3600\n"
      "  mpirun -np 4 antiform run DECK -o out   (continuum only)\n"
      "Exit status: 0 done, "
      "1 error of the deck, an option or a file, 2 error of the physics,\n3 interrupted: "
      "'antiform run DECK -o DIR --resume' goes on\n(not static and buckling runs, which "
      "keep no checkpoint).\n");
  command.callback([&line] { line.command = CommandLine::Command::run; });
}

void add_calibrate(CLI::App &app, CommandLine &line)
{
  CLI::App &command = *app.add_subcommand(
      "calibrate", "micro-parameters of the grains from laboratory targets");
  add_deck(command, line.run);
  add_output(command, line.run);
  command.add_flag("--resume", line.run.resume,
                   "go on in the output directory; finished trials are not run again");
  command.footer(
      "Example:\n  antiform calibrate cases/laboratory/calibrate-rock-1.prm -o rock-1\n"
      "  antiform calibrate cases/laboratory/calibrate-rock-1.prm -o rock-1 --resume\n"
      "  /usr/bin/python3 cases/calibration_plot.py rock-1\n"
      "'antiform check DECK' says beforehand how many trials and how long.\n"
      "Exit status: 0 targets met on fresh packings, 1 error of the deck, an option or a "
      "file,\n2 not met (the best rock is written) or a trial failed, 3 interrupted.\n");
  command.callback([&line] { line.command = CommandLine::Command::calibrate; });
}

void add_study(CLI::App &app, CommandLine &line)
{
  CLI::App &command = *app.add_subcommand(
      "study", "every combination of values of a deck's section Study, in one table");
  add_deck(command, line.run);
  add_output(command, line.run);
  command.add_option("--jobs", line.jobs, "members at once (as many as cores)")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  add_threads(command, line.run, "threads of each member (cores that --jobs leaves free)");
  command.footer(
      "Example:\n  antiform study cases/burial-depth/study.prm -o depths\n"
      "  antiform report depths\n"
      "The same command goes on with a study that was stopped or killed; members that "
      "have ended are\nnot run again, and a changed section Study adds to them.\n"
      "Exit status: 0 all members done, 1 error of the deck, an option or a file "
      "(nothing is run),\n2 some members failed (the others went on), 3 interrupted.\n");
  command.callback([&line] { line.command = CommandLine::Command::study; });
}

void add_check(CLI::App &app, CommandLine &line)
{
  CLI::App &command = *app.add_subcommand(
      "check",
      "what a deck makes: scene, effects and why, sizes, predicted time and memory");
  add_deck(command, line.run);
  add_threads(command, line.run);
  command.add_flag("--json", line.json, "for programs");
  command.footer("Example:\n  antiform check cases/burial-depth/anticline.prm "
                 "--set \"Layer/Grains across=20\"");
  command.callback([&line] { line.command = CommandLine::Command::check; });
}

void add_theory(CLI::App &app, CommandLine &line)
{
  CLI::App &command =
      *app.add_subcommand("theory", "the closed forms for a deck's scene: regime, "
                                    "critical stress, wavelength, mechanism");
  add_deck(command, line.run);
  CLI::Option *const json =
      command.add_flag("--json", line.theory.json, "for programs (SI units)");
  CLI::Option *const plot =
      command
          .add_option("--plot", line.theory.plot,
                      "draw the diagram of gamma against Lambda into this file")
          ->check(
              [](const std::string &name)
              {
                const bool is_svg =
                    name.size() > 4 && name.compare(name.size() - 4, 4, ".svg") == 0;
                return is_svg ? "" : "give a name that ends in .svg";
              })
          ->type_name("FILE.svg");
  command
      .add_option("--along", line.theory.along,
                  "a table (CSV) of the closed forms along these values, written as "
                  "'Study/Vary' in a deck")
      ->excludes(json)
      ->excludes(plot)
      ->type_name("ENTRY=VALUES");
  command
      .add_option("--friction-angle", line.theory.friction_angle,
                  "of the rock, by which confinement adds to its strength; 'antiform "
                  "envelope' finds it (42, that of rock 1) [degrees]")
      ->check(CLI::Range(0., 80.))
      ->type_name("DEGREES");
  command.footer("Example:\n  antiform theory cases/burial-depth/anticline.prm\n"
                 "  antiform theory cases/burial-depth/anticline.prm --plot diagram.svg "
                 "--set \"Matrix/Burial depth ratio=10\"\n"
                 "  antiform theory cases/burial-depth/study.prm --set \"Matrix/Cover "
                 "rows=1\" --along \"Matrix/Burial depth ratio = 0.01 to 100 in 60 "
                 "logarithmic\"");
  command.callback([&line] { line.command = CommandLine::Command::theory; });
}

void add_parameters(CLI::App &app, CommandLine &line)
{
  CLI::App &command =
      *app.add_subcommand("parameters", "every parameter: meaning, unit, default, range");
  command.add_option("NAME", line.name, "only those with NAME in their path");
  command.add_flag("--markdown", line.markdown, "all of them, as docs/parameters.md");
  command.footer("Example:\n  antiform parameters overlap");
  command.callback([&line] { line.command = CommandLine::Command::parameters; });
}

void add_envelope(CLI::App &app, CommandLine &line)
{
  CLI::App &command = *app.add_subcommand(
      "envelope", "Mohr-Coulomb and Hoek-Brown envelopes of laboratory tests");
  command
      .add_option("SOURCE", line.sources,
                  "directories of finished runs of cases/laboratory, or tables (.csv) "
                  "with columns sigma3_MPa, sigma1_MPa and perhaps site")
      ->required();
  command.add_flag("--json", line.json, "for programs");
  command.footer("Example:\n  antiform envelope uniaxial biaxial-10 biaxial-20 tension\n"
                 "  antiform envelope cases/laboratory/limestones.csv");
  command.callback([&line] { line.command = CommandLine::Command::envelope; });
}

void add_report(CLI::App &app, CommandLine &line)
{
  CLI::App &command = *app.add_subcommand(
      "report",
      "one self-contained page of a run or a study: numbers, curves, pictures, cost");
  command.add_option("DIR", line.report.directory, "directory of a run, or of a study")
      ->required()
      ->type_name("DIR");
  command
      .add_option("-o,--output", line.report.page, "the page to write (DIR/report.html)")
      ->type_name("FILE.html");
  command
      .add_option("--steps", line.report.steps,
                  "fields that are drawn: onset (of cracking), peak, first, last, or the "
                  "numbers of field files (onset,peak,last)")
      ->type_name("STEP,STEP");
  command.footer("Example:\n  antiform report out\n"
                 "  antiform report out -o anticline.html --steps first,peak,12");
  command.callback([&line] { line.command = CommandLine::Command::report; });
}

void add_compare(CLI::App &app, CommandLine &line)
{
  CLI::App &command = *app.add_subcommand(
      "compare", "finished runs of one scene: differences, scatter and cost side by side");
  command
      .add_option("DIR", line.comparison.runs,
                  "directories of runs; the first is what the others are held against, "
                  "runs that differ in seeds alone are taken together")
      ->required()
      ->type_name("DIR");
  command
      .add_option("-o,--output", line.comparison.output,
                  "directory of the page and the tables (comparison)")
      ->type_name("DIR");
  command.footer("Example:\n  antiform run DECK -o pure --set Matrix/Representation=grains\n"
                 "  antiform run DECK -o coupled\n"
                 "  antiform compare pure coupled\n"
                 "Runs of other seeds (--set Layer/Seed=2) tell differences from scatter.");
  command.callback([&line] { line.command = CommandLine::Command::compare; });
}

} // namespace

CommandLine parse_command_line(const std::vector<std::string> &arguments)
{
  CommandLine line;
  CLI::App app("antiform: how a competent rock layer folds and breaks inside weaker rock",
               "antiform");
  app.require_subcommand(1);
  app.footer("Example:\n  antiform run cases/burial-depth/quick.prm\n"
             "'antiform COMMAND --help' says more.");
  add_run(app, line);
  add_check(app, line);
  add_theory(app, line);
  add_parameters(app, line);
  add_envelope(app, line);
  add_calibrate(app, line);
  add_report(app, line);
  add_compare(app, line);
  add_study(app, line);

  const std::string name = arguments.empty() ? "" : arguments.front();
  std::string names;
  bool is_there = name.empty() || name.front() == '-'; // an option: --help
  for (const CLI::App *command : app.get_subcommands({}))
  {
    names += (names.empty() ? "" : ", ") + command->get_name();
    is_there = is_there || command->get_name() == name;
  }
  if (!is_there)
    throw InputError(
        {"antiform " + name + ": there is no such command. Commands are " + names + "."});

  try
  {
    // CLI11 takes the arguments from the back.
    std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
    app.parse(reversed);
  }
  catch (const CLI::ParseError &error)
  {
    std::ostringstream out, err;
    if (app.exit(error, out, err) != 0)
    {
      std::string text = err.str();
      while (!text.empty() && text.back() == '\n')
        text.pop_back();
      throw InputError({"command line: " + text});
    }
    line.command = CommandLine::Command::help;
    line.help_text = out.str();
  }
  return line;
}
} // namespace antiform::cases
