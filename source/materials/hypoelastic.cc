// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/materials/elastic_material.h>
#include <alveolus/materials/ellipticity.h>
#include <alveolus/materials/hypoelastic.h>

#include <cmath>

namespace alveolus
{
  using dealii::SymmetricTensor;
  using dealii::Tensor;

  void
  Hypoelastic::declare_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Selection;
    input.declare(prm);
    prm.add_parameter("Poisson's ratio",
                      poisson,
                      "Poisson's ratio nu [-], between -1 and 0.5.",
                      dealii::Patterns::Double(-1., 0.5));
    prm.add_parameter("Strain measure",
                      measure_of,
                      "Strain by which the modulus is looked up: equivalent, "
                      "largest principal (tensile and compressive), or "
                      "volumetric.",
                      Selection("equivalent|largest principal|volumetric"));
    prm.add_parameter("Conversion",
                      conversion,
                      "none: the table relates true stress and logarithmic "
                      "strain; uniaxial: engineering stress and strain of a "
                      "uniaxial test.",
                      Selection("none|uniaxial"));
    prm.add_parameter("Modulus at",
                      modulus_at,
                      "mean of step: between the strains at its beginning and "
                      "end; beginning of step: as explicit codes look it up.",
                      Selection("mean of step|beginning of step"));
  }



  void
  Hypoelastic::initialize(const unsigned int dim, const std::string &where)
  {
    this->dim = dim;
    table     = input.table(where);
    const LameConstants unit(1., poisson, where);
    lambda       = unit.lambda;
    mu           = unit.mu;
    kind         = measure_of == "volumetric"          ? Measure::volumetric
                   : measure_of == "largest principal" ? Measure::largest_principal
                                                       : Measure::equivalent;
    converted    = (conversion == "uniaxial");
    mean_of_step = (modulus_at == "mean of step");
    const HistoryLayout layout(history_fields(), dim);
    stress_at = layout.offset("stress");
    work_at   = layout.offset("stress work");
  }



  std::vector<HistoryField>
  Hypoelastic::history_fields() const
  {
    // The strain comes first: see Material::volume_ratio().
    HistoryField strain, stress, work;
    strain.name  = "elastic strain";
    strain.shape = HistoryField::Shape::symmetric_tensor;
    stress.name  = "stress";
    stress.unit  = "MPa";
    stress.shape = HistoryField::Shape::symmetric_tensor;
    work.name    = "stress work";
    work.unit    = "MPa";
    return {strain, stress, work};
  }



  void
  Hypoelastic::initial_history(double *values) const
  {
    pack(SymmetricTensor<2, 3>(), values, dim);
    pack(SymmetricTensor<2, 3>(), values + stress_at, dim);
    values[work_at] = 0.;
  }



  Hypoelastic::Strain
  Hypoelastic::measure(const Spectral &b, const SymmetricTensor<2, 3> &h) const
  {
    const auto I = dealii::unit_symmetric_tensor<3>();
    Strain     strain;
    if (kind == Measure::volumetric)
      {
        strain.tensile = strain.compressive = trace(h);
        strain.d_tensile = strain.d_compressive = I;
        return strain;
      }

    const auto   dev    = deviator(h);
    const double length = dev.norm();
    if (length > 0.)
      {
        const double root_6 = std::sqrt(6.);
        const auto   n      = dev / length;
        const double det    = determinant(n);
        strain.lode         = 3. * root_6 * det;
        // d det(n) = (n^2 - I/3 - 3 det(n) n) : dh / |dev h|
        strain.d_lode = 3. * root_6 / length *
                        (symmetrize(Tensor<2, 3>(n) * Tensor<2, 3>(n)) -
                         I / 3. - 3. * det * n);
      }
    if (kind == Measure::largest_principal)
      {
        // The eigenvectors are those of b = exp(2 h).
        const auto dyad = [&](const unsigned int a) {
          return symmetrize(outer_product(b.vectors[a], b.vectors[a]));
        };
        strain.tensile       = 0.5 * std::log(b.values[0]);
        strain.compressive   = 0.5 * std::log(b.values[2]);
        strain.d_tensile     = dyad(0);
        strain.d_compressive = dyad(2);
      }
    else
      {
        const double factor = std::sqrt(1.5) / (1. + poisson);
        strain.tensile      = factor * length;
        strain.compressive  = -strain.tensile;
        if (length > 0.)
          strain.d_tensile = factor / length * dev;
        strain.d_compressive = -strain.d_tensile;
      }
    return strain;
  }



  double
  Hypoelastic::modulus(const double m) const
  {
    const double strain = std::expm1(m), l = strain + 1.;
    const double tangent = table.modulus(strain);
    return converted ? l * (table.stress(strain) + l * tangent) : tangent;
  }



  double
  Hypoelastic::integral(const double m) const
  {
    const double strain = std::expm1(m);
    return converted ? (strain + 1.) * table.stress(strain)
                     : table.logarithmic_stress(strain);
  }



  double
  Hypoelastic::mean(const double before,
                    const double after,
                    double      &slope) const
  {
    const double step = after - before;
    if (std::abs(step) < 1e-6) // all round-off
      {
        slope = 0.;
        return modulus(0.5 * (before + after));
      }
    const double result = (integral(after) - integral(before)) / step;
    slope               = (modulus(after) - result) / step;
    return result;
  }



  double
  Hypoelastic::step_modulus(const Strain          &before,
                            const Strain          &after,
                            SymmetricTensor<2, 3> &derivative) const
  {
    derivative = SymmetricTensor<2, 3>();
    if (!mean_of_step)
      return 0.5 * (1. + before.lode) * modulus(before.tensile) +
             0.5 * (1. - before.lode) * modulus(before.compressive);
    double       slope_stretched, slope_compressed;
    const double stretched =
      mean(before.tensile, after.tensile, slope_stretched);
    const double compressed =
      mean(before.compressive, after.compressive, slope_compressed);
    derivative =
      0.5 * ((1. + after.lode) * slope_stretched * after.d_tensile +
             (1. - after.lode) * slope_compressed * after.d_compressive +
             (stretched - compressed) * after.d_lode);
    return 0.5 *
           ((1. + after.lode) * stretched + (1. - after.lode) * compressed);
  }



  void
  Hypoelastic::evaluate(const Tensor<2, 3> &f,
                        const double       *old,
                        double             *trial,
                        const bool          need_tangent,
                        MaterialResponse   &response) const
  {
    const SymmetricTensor<2, 3> h_old      = unpack(old, dim);
    const SymmetricTensor<2, 3> stress_old = unpack(old + stress_at, dim);
    const Increment             increment(f, h_old);
    const Polar                 turn          = polar(f);
    const SymmetricTensor<2, 3> h             = increment.strain();
    const SymmetricTensor<2, 3> dh            = h - rotate(turn.R, h_old);
    const SymmetricTensor<2, 3> stress_turned = rotate(turn.R, stress_old);

    Spectral b_old;
    // The measures are isotropic: that of h_n needs no turn.
    b_old = spectral(h_old);
    for (double &value : b_old.values)
      value = std::exp(2. * value);
    SymmetricTensor<2, 3> derivative;
    const double          M =
      step_modulus(measure(b_old, h_old), measure(increment.b, h), derivative);

    const SymmetricTensor<2, 3> unit_stress =
      lambda * trace(dh) * dealii::unit_symmetric_tensor<3>() + 2. * mu * dh;
    response.stress = stress_turned + M * unit_stress;
    response.energy =
      old[work_at] + 0.5 * (stress_turned + response.stress) * dh;
    pack(h, trial, dim);
    pack(response.stress, trial + stress_at, dim);
    trial[work_at] = response.energy;
    if (!need_tangent)
      return;

    Mandel66      C;
    const Mandel6 rows    = to_mandel(unit_stress),
                  columns = to_mandel(derivative);
    for (unsigned int i = 0; i < 6; ++i)
      for (unsigned int j = 0; j < 6; ++j)
        C[i][j] = rows[i] * columns[j] + M * ((i < 3 && j < 3 ? lambda : 0.) +
                                              (i == j ? 2. * mu : 0.));
    structural_tangent(increment, turn.V, C, response);
  }



  std::vector<std::pair<std::string, std::string>>
  Hypoelastic::derived_names() const
  {
    return {{"von Mises stress", "MPa"},
            {"pressure", "MPa"},
            {"tangent modulus", "MPa"},
            {"ellipticity", ""}};
  }



  std::vector<double>
  Hypoelastic::derived_values(const double *history) const
  {
    const SymmetricTensor<2, 3> stress = unpack(history + stress_at, dim);
    const Tensor<2, 3>          at_rest(dealii::unit_symmetric_tensor<3>());
    std::vector<double>         unused(work_at + 1);
    MaterialResponse            response;
    evaluate(at_rest, history, unused.data(), true, response);
    const SymmetricTensor<2, 3> h = unpack(history, dim);
    const Increment             increment(at_rest, h);
    SymmetricTensor<2, 3>       derivative;
    const Strain                strain = measure(increment.b, h);
    const double current = step_modulus(strain, strain, derivative);
    return {von_mises(stress),
            -trace(stress) / 3.,
            current,
            least_acoustic_eigenvalue(response, increment.b, dim) /
              (mu * table.modulus(0.))};
  }
} // namespace alveolus

ALVEOLUS_REGISTER(
  alveolus::Material,
  alveolus::Hypoelastic,
  "hypoelastic",
  "Incremental reading of a uniaxial table of tangent moduli (`Table file` or "
  "`Tangent modulus`): dtau = M C(nu) : dh between the Kirchhoff stress tau and "
  "the Hencky strain h in the frame turning with the increment, C(nu) Hooke's "
  "tensor for a modulus of 1 with nu = `Poisson's ratio`. The modulus M is that "
  "of the table (`Conversion` = none), or the one whose uniaxial test is the "
  "table (uniaxial), at strains exp(m) - 1, m chosen by `Strain measure`: the "
  "equivalent strain +-sqrt(3/2) |dev h|/(1+nu), the largest and the smallest "
  "principal strain, or the volume strain tr h; tension and compression weigh "
  "(1+L)/2 and (1-L)/2 with the Lode parameter L of dev h. `Modulus at` says whether it is the mean over the step or "
  "that of its beginning. There is no energy; the work of the stress stands "
  "for it. Derived quantities: `tangent modulus` M and `ellipticity`, the "
  "least eigenvalue of the acoustic tensor over the initial shear modulus.")
