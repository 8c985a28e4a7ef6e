// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_io_field_error_h
#define alveolus_io_field_error_h

#include <alveolus/base/expressions.h>
#include <alveolus/io/recorder.h>

#include <memory>
#include <set>

namespace alveolus
{
  /**
   * How far a history field phi is from a given function phi_0 of place and
   * time: over the current volume of the regions, by the quadrature of the
   * elements,
   *
   *   error               = sqrt(int |phi - phi_0|^2 dv / int |phi_0|^2 dv),
   *   error of cell means = the same with phi and phi_0 replaced by their means
   *                         over each cell.
   *
   * Derivatives of bilinear displacements converge with h at the quadrature
   * points, and with h^2 in the mean over a cell. For tensors |.| is the
   * Frobenius norm. Where phi_0 = 0 everywhere both are absolute.
   */
  template <int dim>
  class FieldError : public Recorder<dim>
  {
  public:
    /**
     * Adds `On`, regions, `Field`, a history field, and `Function`, what it
     * should be.
     */
    void
    declare_parameters(dealii::ParameterHandler &prm) override;
    void
    attach(const State<dim> &state, const std::string &where) override;
    std::vector<Recorded>
    record(const State<dim>  &state,
           const NodalVector &reactions) const override;

  private:
    std::string                                  on, field, text;
    std::set<dealii::types::material_id>         ids;
    unsigned int                                 n_components = 0;
    HistoryField::Shape                          shape;
    std::unique_ptr<dealii::FunctionParser<dim>> function;
  };
} // namespace alveolus

#endif
