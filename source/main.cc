// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/interrupt.h>
#include <alveolus/driver/simulation.h>
#include <alveolus/io/checkpoint.h>
#include <alveolus/scene/settings.h>

#include <boost/program_options.hpp>

#include <filesystem>
#include <iostream>

namespace
{
  using namespace dealii;
  using namespace alveolus;

  struct Options
  {
    std::string              scene, output, resume;
    std::vector<std::string> sets;
    bool                     validate = false, quiet = false, accept = false;
    unsigned int             threads = 0;
  };



  /** The output folder that a checkpoint lies in. */
  std::string
  folder_of(const std::string &checkpoint)
  {
    const auto folder =
      std::filesystem::path(checkpoint).parent_path().parent_path().string();
    return folder.empty() ? "." : folder;
  }



  template <int dim>
  int
  simulate(const ParameterText              &text,
           const Options                    &options,
           std::shared_ptr<const BlockFile> &resumed)
  {
    Log        log(Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0,
            options.quiet);
    const auto scene = std::make_shared<Scene<dim>>(text);
    if (!options.output.empty())
      scene->output_directory = options.output;
    else if (resumed)
      scene->output_directory = folder_of(resumed->source);
    std::vector<std::string> changes;
    if (resumed)
      {
        std::ostringstream resolved;
        scene->write_resolved(resolved);
        changes = check_settings(*resumed, resolved.str(), options.accept);
      }
    // It lets go of the checkpoint when it has begun.
    Simulation<dim> simulation(scene, MPI_COMM_WORLD, log, std::move(resumed));
    for (const auto &change : changes)
      log.say("changed: " + change);
    if (options.validate)
      {
        simulation.describe();
        return 0;
      }
    return simulation.run() ? 0 : 1;
  }
} // namespace

int
main(int argc, char **argv)
{
  namespace po = boost::program_options;
  Options                 options;
  po::options_description all("alveolus [options] SCENE.prm");
  all.add_options()("help,h", "this text")("version", "print the version")(
    "set",
    po::value(&options.sets),
    "'Section/Subsection/Parameter=value', overrides the file (repeatable)")(
    "output", po::value(&options.output), "output folder")(
    "resume",
    po::value(&options.resume),
    "go on from the newest checkpoint of this output folder, or from this "
    "checkpoint file; the scene need not be given")(
    "accept-changes",
    po::bool_switch(&options.accept),
    "resume although settings have changed")(
    "validate",
    po::bool_switch(&options.validate),
    "parse, mesh, check, say what is modelled and what not; solve nothing")(
    "print-parameters",
    "with a scene: its parameters with all defaults; without: the reference of "
    "all parameters as Markdown")("threads",
                                  po::value(&options.threads),
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
  if (given.count("help") > 0)
    {
      std::cout << all
                << "\nExit codes: 0 completed, 1 stopped early (results and "
                   "reason on disk), 2 bad input or usage.\n";
      return 0;
    }
  if (given.count("version") > 0)
    {
      std::cout << "alveolus " ALVEOLUS_VERSION " (deal.II "
                << DEAL_II_PACKAGE_VERSION << ")\n";
      return 0;
    }

  deal_II_exceptions::suppress_stacktrace_in_exceptions();
  int program_name_only = 1; // PETSc would take the options for its own
  Utilities::MPI::MPI_InitFinalize mpi(program_name_only,
                                       argv,
                                       options.threads > 0
                                         ? options.threads
                                         : numbers::invalid_unsigned_int);
  const bool speaks = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  Interrupt::install();
  try
    {
      if (given.count("print-parameters") > 0 && options.scene.empty())
        {
          if (speaks)
            write_reference(std::cout);
          return 0;
        }
      std::shared_ptr<const BlockFile> resumed;
      if (!options.resume.empty())
        resumed = std::make_shared<const BlockFile>(
          read_checkpoint(options.resume, MPI_COMM_WORLD));
      if (options.scene.empty() && !resumed)
        throw InputError("usage",
                         "no parameter file given",
                         "write alveolus SCENE.prm, or see alveolus --help");
      const ParameterText text =
        options.scene.empty()
          ? saved_settings(*resumed, options.sets)
          : ParameterText::read(options.scene, options.sets);
      const bool three = text.value("Dimension", "2") == "3";
      if (given.count("print-parameters") > 0)
        {
          if (speaks && three)
            Scene<3>(text).write_resolved(std::cout);
          else if (speaks)
            Scene<2>(text).write_resolved(std::cout);
          return 0;
        }
      return three ? simulate<3>(text, options, resumed)
                   : simulate<2>(text, options, resumed);
    }
  catch (const InputError &error)
    {
      if (speaks)
        std::cerr << "alveolus: " << error.what() << std::endl;
      return 2;
    }
  catch (const UserError &error)
    {
      if (speaks)
        std::cerr << "alveolus: " << error.what() << std::endl;
      return 1;
    }
  catch (const ExceptionBase &error)
    {
      std::ostringstream message;
      error.print_info(message);
      if (speaks)
        std::cerr << "alveolus: internal error: " << message.str() << std::endl;
      return 1;
    }
  catch (const std::exception &error)
    {
      if (speaks)
        std::cerr << "alveolus: " << error.what() << std::endl;
      return 1;
    }
}
