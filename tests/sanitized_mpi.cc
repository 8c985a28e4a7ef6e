// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Only in builds with sanitizers: what the MPI library allocates when it starts
// and ends is not counted as a leak, and its plug-ins stay loaded, so that
// suppressions by their names (leaks.supp) work when LeakSanitizer looks at the
// end. These functions stand in front of the libraries' own; those of MPI are
// called PMPI by the standard's profiling interface.
#include <mpi.h>
#include <sanitizer/lsan_interface.h>

namespace
{
  /** Whatever is allocated while it lives is no leak. */
  struct NoLeaks
  {
    NoLeaks()
    {
      __lsan_disable();
    }
    ~NoLeaks()
    {
      __lsan_enable();
    }
  };
} // namespace



extern "C" int
MPI_Init_thread(int *argc, char ***argv, int required, int *provided)
{
  const NoLeaks no_leaks;
  return PMPI_Init_thread(argc, argv, required, provided);
}



extern "C" int
MPI_Finalize()
{
  const NoLeaks no_leaks;
  return PMPI_Finalize();
}



extern "C" int
dlclose(void *)
{
  return 0;
}
