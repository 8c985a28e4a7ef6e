// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_io_field_writer_h
#define alveolus_io_field_writer_h

#include <alveolus/assembly/cell_kernel.h>
#include <alveolus/base/block_file.h>
#include <alveolus/state/state.h>

#include <string>
#include <utility>
#include <vector>

namespace alveolus
{
  /**
   * Writes the fields of a state for ParaView: one VTU file for each process, a
   * PVTU file that joins them and a PVD file with the times. Nodal: material
   * displacement. Cell means of the quadrature points: every scalar history
   * field, what the materials derive from their history (damage, stimulus,
   * stress), region number and mesh quality (scaled Jacobian). Cells whose
   * region does not know a field hold NaN there.
   */
  template <int dim>
  class FieldWriter
  {
  public:
    /** @param directory existing folder */
    explicit FieldWriter(const std::string &directory);

    /**
     * Write one time; each file as a whole or not at all.
     * @throws RunError if a file cannot be written
     */
    void
    write(const State<dim> &state, const std::vector<Region> &regions);

    /** Into and from blocks "fields/...": what was written so far. */
    void
    save(BlockFile &blocks) const;
    /** The same back. @throws InputError */
    void
    load(const BlockFile &blocks);

  private:
    std::string                                 directory;
    std::vector<std::pair<double, std::string>> times;
  };

  /** Cell means of one named quantity; see FieldWriter for the names. */
  template <int dim>
  std::vector<std::pair<std::string, dealii::Vector<float>>>
  cell_fields(const State<dim> &state, const std::vector<Region> &regions);
} // namespace alveolus

#endif
