// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/interrupt.h>
#include <alveolus/driver/program.h>

#include <deal.II/base/config.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>

#include <boost/program_options.hpp>

#include <iostream>

int
main(int argc, char **argv)
{
  using namespace alveolus;
  namespace po = boost::program_options;
  ProgramOptions          options;
  unsigned int            threads = 0;
  std::string             accuracy;
  po::options_description all("alveolus [options] SCENE.prm");
  all.add_options()("help,h", "this text")("version", "print the version")(
    "set",
    po::value(&options.sets),
    "'Section/Subsection/Parameter=value', overrides the file (repeatable)")(
    "accuracy",
    po::value(&accuracy),
    "accuracy level of the scene: fast, balanced or reference")(
    "output", po::value(&options.output), "output folder")(
    "resume",
    po::value(&options.resume),
    "go on from the newest checkpoint of this output folder, or from this "
    "checkpoint file; the scene need not be given")(
    "accept-changes",
    po::bool_switch(&options.accept),
    "resume although settings have changed")(
    "allow-scripts",
    po::bool_switch(&options.allow_scripts),
    "let gmsh run a script (.geo) that a scene names as its mesh file; it can "
    "start programs")(
    "validate",
    po::bool_switch(&options.validate),
    "parse, mesh, check, say what is modelled and what not; solve nothing")(
    "print-parameters",
    po::bool_switch(&options.print_parameters),
    "with a scene: its parameters with all defaults; without: the reference of "
    "all parameters as Markdown")("threads",
                                  po::value(&threads),
                                  "threads per process (default: all cores)")(
    "quiet", po::bool_switch(&options.quiet), "no messages on the screen")(
    "scene", po::value(&options.scene), "the parameter file");
  po::positional_options_description positional;
  positional.add("scene", 1);
  po::variables_map given;
  try
    {
      po::store(po::command_line_parser(argc, argv)
                  .options(all)
                  .positional(positional)
                  .run(),
                given);
      po::notify(given);
    }
  catch (const po::error &error)
    {
      std::cerr << "alveolus: " << error.what() << "; see alveolus --help\n";
      return 2;
    }
  if (given.count("accuracy") > 0)
    options.sets.push_back("Accuracy=" + accuracy);
  if (given.count("help") > 0)
    {
      std::cout << all
                << "\nExit codes: 0 completed, 1 stopped early (results and "
                   "reason on disk), 2 bad input or usage.\n"
                   "The environment variable ALVEOLUS_MESHER names the program "
                   "gmsh, if it is not found.\n";
      return 0;
    }
  if (given.count("version") > 0)
    {
      std::cout << "alveolus " ALVEOLUS_VERSION " (deal.II "
                << DEAL_II_PACKAGE_VERSION << ")\n";
      return 0;
    }

  dealii::deal_II_exceptions::suppress_stacktrace_in_exceptions();
  int program_name_only = 1; // PETSc would take the options for its own
  dealii::Utilities::MPI::MPI_InitFinalize mpi(
    program_name_only,
    argv,
    threads > 0 ? threads : dealii::numbers::invalid_unsigned_int);
  Interrupt::install();
  return run_program(options, MPI_COMM_WORLD, std::cerr);
}
