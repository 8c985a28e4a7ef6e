// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/io/mesh_picture.h>
#include <alveolus/io/named_sizes.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numeric>
#include <tuple>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    // Layout in pixels
    constexpr double drawing = 900., column = 230., margin = 25., row = 21.;

    const std::array<const char *, 8> region_colours = {{"#c9dcee",
                                                         "#fbe6bb",
                                                         "#cfe8c5",
                                                         "#f0cfd6",
                                                         "#ddd3ec",
                                                         "#c5e6e3",
                                                         "#eadcc8",
                                                         "#d9d9d9"}};
    const std::array<const char *, 8> line_colours   = {{"#1b5fa8",
                                                         "#c2410c",
                                                         "#15803d",
                                                         "#9d174d",
                                                         "#6d28d9",
                                                         "#0f766e",
                                                         "#92400e",
                                                         "#374151"}};

    // The picture

    std::string
    format(const char *const pattern, const double a, const double b = 0.)
    {
      char text[200];
      std::snprintf(text, sizeof(text), pattern, a, b);
      return text;
    }

    std::string
    escaped(const std::string &text)
    {
      std::string result;
      for (const char c : text)
        result += c == '&'   ? "&amp;"
                  : c == '<' ? "&lt;"
                  : c == '>' ? "&gt;"
                             : std::string(1, c);
      return result;
    }

    /** A name, the place it belongs to, and where its text stands. */
    struct Label
    {
      std::string text, colour;
      Point<2>    anchor; ///< [pixels]
      double      height = 0.;
    };

    /** Give the labels of one column heights without overlap. */
    void
    spread(std::vector<Label> &labels, const double lowest)
    {
      std::sort(labels.begin(), labels.end(), [](const auto &a, const auto &b) {
        return std::tie(a.anchor[1], a.text) < std::tie(b.anchor[1], b.text);
      });
      double last = margin + row;
      for (Label &label : labels)
        {
          label.height = std::max(label.anchor[1] + 5., last);
          last         = label.height + row;
        }
      last = std::max(lowest, margin + row * (labels.size() + 1));
      for (auto label = labels.rbegin(); label != labels.rend(); ++label)
        {
          label->height = std::min(label->height, last);
          last          = label->height - row;
        }
    }

    /** Projection to the plane of the picture: right, up, towards the eye. */
    template <int dim>
    Point<3>
    seen(const Point<dim> &p)
    {
      if constexpr (dim == 2)
        return Point<3>(p[0], p[1], 0.);
      else
        {
          // y is up: the axis of teeth. Planes of symmetry are at z = 0.
          const Tensor<1, 3> eye   = Point<3>(1., 0.9, -1.6) / std::sqrt(4.37);
          Tensor<1, 3>       right = Point<3>(-1.6, 0., -1.);
          right /= right.norm();
          const Tensor<1, 3> up = cross_product_3d(eye, right);
          return Point<3>(right * p, up * p, eye * p);
        }
    }

    /** Length of a scale bar: 1, 2 or 5 times a power of ten. */
    double
    nice_length(const double longest)
    {
      const double power = std::pow(10., std::floor(std::log10(longest)));
      return longest >= 5. * power   ? 5. * power
             : longest >= 2. * power ? 2. * power
                                     : power;
    }

    template <int dim>
    class Picture
    {
    public:
      Picture(const NamedSets<dim> &names, const GatheredPieces<dim> &mesh)
        : names(names)
        , mesh(mesh)
      {
        for (unsigned int d = 0; d < 2; ++d)
          {
            low[d]  = std::numeric_limits<double>::max();
            high[d] = -low[d];
          }
        for (const MeshPiece<dim> &piece : mesh.pieces)
          for (const Point<dim> &corner : piece.corners)
            {
              const Point<3> p = seen(corner);
              for (unsigned int d = 0; d < 2; ++d)
                {
                  low[d]  = std::min(low[d], p[d]);
                  high[d] = std::max(high[d], p[d]);
                }
            }
        scale =
          drawing / std::max({high[0] - low[0], high[1] - low[1], 1e-300});
      }

      std::string
      draw(const std::string &title)
      {
        for (const auto &region : names.regions)
          for (const types::material_id id : region.second)
            colour_of.emplace(
              id, region_colours[colour_of.size() % region_colours.size()]);
        cells();
        if constexpr (dim == 2)
          curves();
        else
          boundaries();
        for (const auto &point : names.points)
          {
            const Point<2> p = pixels(point.second);
            body += format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3.5\"/>\n",
                           p[0],
                           p[1]);
            labels.push_back({point.first, "#000", p, 0.});
          }
        const double height = write_labels();
        return finished(title, height);
      }

    private:
      Point<2>
      pixels(const Point<dim> &q) const
      {
        const Point<3> p = seen(q);
        return {margin + column + scale * (p[0] - low[0]),
                2. * margin + scale * (high[1] - p[1])};
      }

      void
      cells()
      {
        std::vector<const MeshPiece<dim> *> order;
        for (const MeshPiece<dim> &piece : mesh.pieces)
          order.push_back(&piece);
        const auto depth = [](const MeshPiece<dim> *piece) {
          double sum = 0.;
          for (const Point<dim> &corner : piece->corners)
            sum += seen(corner)[2];
          return sum;
        };
        // Far ones first; in 2D region by region, each one path
        if (dim == 3)
          std::stable_sort(order.begin(),
                           order.end(),
                           [&](const auto a, const auto b) {
                             return depth(a) < depth(b);
                           });
        else
          std::stable_sort(order.begin(),
                           order.end(),
                           [](const auto a, const auto b) {
                             return a->material < b->material;
                           });
        const double width =
          std::min(0.8, 30. / std::sqrt(1. + mesh.pieces.size()));
        body += format(
          "<g stroke=\"#555\" stroke-width=\"%.2f\" "
          "stroke-linejoin=\"round\">\n",
          width);
        std::string        path;
        types::material_id current = 0;
        const auto         flush   = [&]() {
          if (!path.empty())
            body +=
              "<path fill=\"" + colour(current) + "\" d=\"" + path + "\"/>\n";
          path.clear();
        };
        for (const MeshPiece<dim> *const piece : order)
          {
            if (dim == 3 || piece->material != current)
              flush();
            current = piece->material;
            for (unsigned int k = 0; k < 4; ++k)
              {
                const Point<2> p = pixels(piece->corners[k]);
                path +=
                  format(k == 0 ? "M%.2f %.2f" : "L%.2f %.2f", p[0], p[1]);
              }
            path += "Z";
          }
        flush();
        body += "</g>\n";
      }

      std::string
      colour(const types::material_id id) const
      {
        const auto entry = colour_of.find(id);
        return entry == colour_of.end() ? "#eee" : entry->second;
      }

      /** The middle of the member next to the mean of all. */
      template <class Members>
      Point<2>
      anchor(const Members &members) const
      {
        Tensor<1, 2> mean;
        for (const Point<2> &p : members)
          mean += (p - Point<2>()) / double(members.size());
        return *std::min_element(members.begin(),
                                 members.end(),
                                 [&mean](const auto &p, const auto &q) {
                                   return (p - Point<2>() - mean).norm() <
                                          (q - Point<2>() - mean).norm();
                                 });
      }

      void
      curves()
      {
        std::set<std::string> all;
        for (const auto &entry : names.boundaries)
          all.insert(entry.first);
        for (const auto &entry : names.curves)
          all.insert(entry.first);
        unsigned int n = 0;
        for (const std::string &name : all)
          {
            const auto lines = lines_of(name, names, mesh);
            if (lines.first.empty())
              continue;
            const std::string colour = line_colours[n++ % line_colours.size()];
            std::vector<Point<2>> middles;
            body += "<path fill=\"none\" stroke=\"" + colour +
                    "\" stroke-width=\"3\" stroke-linecap=\"round\"" +
                    (lines.second ? "" : " stroke-dasharray=\"7 5\"") + " d=\"";
            for (const NamedLine *const line : lines.first)
              {
                const Point<2> a = pixels(line->a), b = pixels(line->b);
                body += format("M%.2f %.2f", a[0], a[1]) +
                        format("L%.2f %.2f", b[0], b[1]);
                middles.push_back(a + 0.5 * (b - a));
              }
            body += "\"/>\n";
            labels.push_back({name, colour, anchor(middles), 0.});
          }
      }

      void
      boundaries()
      {
        unsigned int n = 0;
        for (const auto &boundary : names.boundaries)
          {
            std::vector<Point<2>> middles;
            for (const MeshPiece<dim> &piece : mesh.pieces)
              if (boundary.second.count(piece.boundary) > 0)
                middles.push_back(
                  pixels(piece.corners[0] +
                         0.5 * (piece.corners[2] - piece.corners[0])));
            const std::string colour = line_colours[n++ % line_colours.size()];
            if (!middles.empty())
              labels.push_back({boundary.first, colour, anchor(middles), 0.});
          }
      }

      /** @return height that the drawing takes */
      double
      write_labels()
      {
        const double middle =
          margin + column + 0.5 * scale * (high[0] - low[0]);
        const double       lowest = margin + scale * (high[1] - low[1]) + row;
        std::vector<Label> sides[2];
        for (const Label &label : labels)
          sides[label.anchor[0] < middle ? 0 : 1].push_back(label);
        // No side much longer than the other
        for (unsigned int s = 0; s < 2; ++s)
          while (sides[s].size() > sides[1 - s].size() + 4)
            {
              const auto nearest =
                std::min_element(sides[s].begin(),
                                 sides[s].end(),
                                 [middle](const auto &a, const auto &b) {
                                   return std::abs(a.anchor[0] - middle) <
                                          std::abs(b.anchor[0] - middle);
                                 });
              sides[1 - s].push_back(*nearest);
              sides[s].erase(nearest);
            }
        double end = lowest;
        for (unsigned int s = 0; s < 2; ++s)
          {
            spread(sides[s], lowest);
            const double x =
              s == 0 ? margin + column - 25.
                     : margin + column + scale * (high[0] - low[0]) + 25.;
            for (const Label &label : sides[s])
              {
                const std::string colour = "\" fill=\"" + label.colour + "\"";
                body += "<path fill=\"none\" stroke=\"" + label.colour +
                        "\" stroke-width=\"0.8\" d=\"" +
                        format("M%.1f %.1f", x, label.height - 5.) +
                        format("L%.1f %.1f", label.anchor[0], label.anchor[1]) +
                        "\"/>\n" +
                        format("<text x=\"%.1f\" y=\"%.1f",
                               x + (s == 0 ? -5. : 5.),
                               label.height) +
                        "\" text-anchor=\"" + (s == 0 ? "end" : "start") +
                        colour + ">" + escaped(label.text) + "</text>\n";
                end = std::max(end, label.height);
              }
          }
        return end;
      }

      std::string
      finished(const std::string &title, const double end) const
      {
        const double width =
          2. * (margin + column) + scale * (high[0] - low[0]);
        double      y = end + 2. * row;
        std::string legend =
          format("<text x=\"%.1f\" y=\"%.1f\"", margin, margin) +
          " font-weight=\"bold\">" + escaped(title) + "</text>\n";
        const double bar = nice_length(0.4 * drawing / scale);
        legend +=
          format(
            "<path stroke=\"#000\" stroke-width=\"3\" d=\"M%.1f "
            "%.1f",
            margin,
            y - 5.) +
          format("H%.1f\"/>\n", margin + bar * scale) +
          format("<text x=\"%.1f\" y=\"%.1f\">", margin + bar * scale + 8., y) +
          format("%g mm</text>\n", bar);
        for (const auto &region : names.regions)
          {
            y += row;
            unsigned int n      = 0;
            double       volume = 0.;
            for (const types::material_id id : region.second)
              if (mesh.cells.count(id) > 0)
                {
                  n += mesh.cells.at(id).first;
                  volume += mesh.cells.at(id).second;
                }
            legend +=
              format(
                "<rect x=\"%.1f\" y=\"%.1f\" width=\"18\" height=\"14\" "
                "stroke=\"#555\" fill=\"",
                margin,
                y - 13.) +
              (region.second.empty() ? "#eee"
                                     : colour(*region.second.begin())) +
              "\"/>\n" +
              format("<text x=\"%.1f\" y=\"%.1f\">", margin + 26., y) +
              escaped(region.first) +
              format(dim == 2 ? ": %.0f cells, %.4g mm\u00b2</text>\n"
                              : ": %.0f cells, %.4g mm\u00b3</text>\n",
                     n,
                     volume);
          }
        const double height = y + margin;
        return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
               "<svg xmlns=\"http://www.w3.org/2000/svg\" " +
               format("width=\"%.0f\" height=\"%.0f\" ", width, height) +
               format("viewBox=\"0 0 %.0f %.0f\" ", width, height) +
               "font-family=\"DejaVu Sans, Arial, sans-serif\" "
               "font-size=\"15\">\n"
               "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" +
               body + legend + "</svg>\n";
      }

      const NamedSets<dim>                     &names;
      const GatheredPieces<dim>                &mesh;
      std::map<types::material_id, std::string> colour_of;
      Tensor<1, 2>                              low, high;  ///< [mm]
      double                                    scale = 1.; ///< [pixels/mm]
      std::string                               body;
      std::vector<Label>                        labels;
    };
  } // namespace



  template <int dim>
  std::string
  mesh_picture(const Mesh<dim> &mesh, const std::string &title)
  {
    const GatheredPieces<dim> all = gather_pieces(mesh);
    if (Utilities::MPI::this_mpi_process(
          mesh.triangulation->get_communicator()) != 0)
      return "";
    return Picture<dim>(mesh.names, all).draw(title);
  }

  template std::string
  mesh_picture(const Mesh<2> &, const std::string &);
  template std::string
  mesh_picture(const Mesh<3> &, const std::string &);
} // namespace alveolus
