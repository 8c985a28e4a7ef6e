// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Mesh files that are damaged, inconsistent or no use: what is said of them.
#include "mesh_source_bench.h"
#include "two_squares.h"

#include <alveolus/base/errors.h>
#include <alveolus/mesh/mesh_checks.h>
#include <alveolus/mesh/msh_reader.h>

#include <gtest/gtest.h>

#include <random>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;



namespace
{
  template <int dim>
  std::string
  message_of_text(const std::string &text)
  {
    write("wrong.msh", text);
    return message<InputError, dim>("file", {{"File name", "wrong.msh"}});
  }



  /** what() of the InputError by which @p text is refused, else "". */
  std::string
  refusal(const std::string &text)
  {
    try
      {
        MeshDescription<2> mesh = read_msh<2>(text, "text");
        check_description(mesh);
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }
} // namespace



TEST(FileSource, WrongFormats)
{
  expect_words(message<InputError, 2>("file", {{"File name", "none.msh"}}),
               {"Mesh / file / File name", "none.msh", "cannot read"});
  expect_words(message<InputError, 2>("file", {}),
               {"Mesh / file / File name", "no file name"});
  expect_words(message<InputError, 2>("file", {{"File name", "."}}),
               {"is a folder"});
  expect_words(message_of_text<2>(""), {"wrong.msh", "$MeshFormat"});
  expect_words(message_of_text<2>("*NODE\n1, 0., 0.\n"),
               {"wrong.msh, line 1", "outside any section"});
  expect_words(message_of_text<2>(with(version_2, "2.2 0", "2.1 0")),
               {"wrong.msh, line 2", "version 2.1", "4.1 or 2.2"});
  expect_words(message_of_text<2>(with(version_4, "4.1 0", "4.0 0")),
               {"line 2", "version 4.0"});
  expect_words(message_of_text<2>(with(version_4, "4.1 0", "4.1 1")),
               {"line 2", "binary", "Mesh.Binary = 0"});
}



TEST(MshReader, TruncatedEverywhere)
{
  for (const std::string &text : {version_2, version_4})
    for (std::size_t end = 0; end + 2 < text.size(); ++end)
      {
        const std::string found = refusal(text.substr(0, end));
        EXPECT_EQ(found.substr(0, 4), "text") << "at " << end << ": " << found;
        if (end > 0 && text[end - 1] == '\n')
          {
            EXPECT_NE(found.find("truncated"), std::string::npos) << found;
          }
      }
}



// Damaged files are refused by InputError or still make a valid mesh; any other
// exception, crash or hang fails the test.
TEST(MshReader, Mutations)
{
  std::mt19937      random(1);
  const std::string letters   = "0123456789 -.e$\n\t\"xN";
  unsigned int      n_refused = 0;
  for (unsigned int i = 0; i < 4000; ++i)
    {
      std::string text = i % 2 == 0 ? version_2 : version_4;
      for (unsigned int n = 1 + random() % 3; n > 0; --n)
        {
          const std::size_t at = random() % text.size();
          switch (random() % 4)
            {
              case 0:
                text[at] = letters[random() % letters.size()];
                break;
              case 1:
                text.insert(at, 1, letters[random() % letters.size()]);
                break;
              case 2:
                text.erase(at, 1 + random() % 12);
                break;
              default:
                text.insert(at, text.substr(random() % text.size(), 20));
            }
        }
      const std::string found = refusal(text);
      n_refused += !found.empty();
      EXPECT_EQ(found.substr(0, 4), found.empty() ? "" : "text") << found;
    }
  EXPECT_GT(n_refused, 2000u);
}



TEST(FileSource, InconsistentSections)
{
  const auto in_2 = [](const std::string &old, const std::string &replacement) {
    return message_of_text<2>(with(version_2, old, replacement));
  };
  const auto in_4 = [](const std::string &old, const std::string &replacement) {
    return message_of_text<2>(with(version_4, old, replacement));
  };
  expect_words(in_2("6 3 2 5 1 1 2 5 4", "6 3 2 5 1 1 2 55 4"),
               {"line 31", "element 6", "unknown node 55"});
  expect_words(in_4("5 1 2 5 4", "5 1 2 55 4"),
               {"line 53", "element 5", "unknown node 55"});
  expect_words(in_2("6 3 2 5 1 1 2 5 4", "6 3 2 5 1 1 2 5"),
               {"line 31", "the line ends before a node number"});
  expect_words(in_2("6 3 2 5 1 1 2 5 4", "6 3 2 5 1 1 2 5 4 3"),
               {"line 31", "'3' is more than"});
  expect_words(in_2("2 1 0 0\n", "2 1 x 0\n"),
               {"line 17", "'x' is not a coordinate"});
  expect_words(in_2("2 1 0 0\n", "2 nan 0 0\n"),
               {"line 17", "not a finite number"});
  expect_words(in_2("2 1 0 0\n", "2 1e999 0 0\n"), {"line 17"});
  expect_words(in_2("2 1 0 0\n", "1 1 0 0\n"),
               {"line 17", "node 1 was already given on line 16"});
  expect_words(in_2("2 1 0 0\n", "2 1 0 0.5\n"),
               {"line 17", "node 2 lies outside the plane"});
  expect_words(in_2("\n7\n1 0 0 0", "\n8\n1 0 0 0"),
               {"line 23", "$EndNodes", "fewer lines"});
  expect_words(in_2("\n7\n1 0 0 0", "\n6\n1 0 0 0"), {"line 22", "more lines"});
  expect_words(in_2("\n7\n1 0 0 0", "\n-7\n1 0 0 0"), {"negative"});
  expect_words(in_2("\n7\n1 0 0 0", "\n99999999999999999\n1 0 0 0"),
               {"line 23", "fewer lines"});
  expect_words(in_2("1 2 \"bottom\"", "1 2 bottom"),
               {"line 7", "quotation marks"});
  expect_words(in_2("1 3 \"start\"", "1 2 \"start\""),
               {"line 8", "a second name for group 2"});
  expect_words(in_2("9 3 2 7 2 2 5 6 3", "9 99 2 7 2 2 5 6 3"),
               {"line 34", "element 9", "type 99"});
  expect_words(in_4("2 7 1 10", "2 8 1 10"),
               {"8 nodes are announced, 7 are given"});
  expect_words(in_4("6 6 1 6", "6 7 1 6"),
               {"7 elements are announced, 6 are given"});
  expect_words(in_4("1 1 1 1\n2 1 2", "2 1 1 1\n2 1 2"),
               {"line 46", "lines on an entity of dimension 2"});
  expect_words(in_4("2 2 3 1", "2 9 3 1"), {"entity 9", "$Entities"});
  expect_words(message_of_text<2>(version_2 + "$Nodes\n0\n$EndNodes\n"),
               {"a second section $Nodes"});
  expect_words(message_of_text<2>(version_2 + "$NodeData\n0\n"),
               {"$NodeData", "has no end"});
}



TEST(FileSource, UnusableMeshes)
{
  const auto in_2 = [](const std::string &old, const std::string &replacement) {
    return message_of_text<2>(with(version_2, old, replacement));
  };
  const std::string second = "8 3 2 6 2 2 5 6 3\n9 3 2 7 2 2 5 6 3\n";
  expect_words(in_2(second, "17 2 2 6 2 2 5 6\n18 2 2 6 2 2 6 3\n"),
               {"wrong.msh",
                "a mesh with a triangle: 2 triangles, first one element 17 at "
                "line 33",
                "recombine"});
  expect_words(in_2(second, "8 16 2 6 2 2 3 6 5 1 4 10 1\n9 3 2 7 2 2 5 6 3\n"),
               {"a quadratic quad", "Mesh.ElementOrder = 1"});
  expect_words(in_2(second, "8 5 2 6 2 1 2 3 4 5 6 1 2\n9 15 1 0 1\n"),
               {"three-dimensional"});
  expect_words(message_of_text<3>(version_2), {"no cells", "hexahedra"});
  expect_words(in_2(second, "8 3 0 2 5 6 3\n9 3 0 2 5 6 3\n"),
               {"line 33",
                "1 cells without a region, first one element 8",
                "Physical group"});
  expect_words(in_2(second, "8 3 2 6 2 2 5 3 6\n9 3 2 7 2 2 5 3 6\n"),
               {"line 33", "element 8 is inverted or flat at node"});
  expect_words(in_2("3 2 0 0\n", "3 1.2 0.6 0\n"),
               {"element 8 is inverted or flat at node 3 (1.2, 0.6)"});
  expect_words(in_2("6 2 1 0\n", "6 2 0 0\n"), {"element 8", "flat"});
  expect_words(in_2("1 15 2 1 1 2", "1 15 2 1 1 10"),
               {"'P' (node 10) is no corner of any cell"});
  expect_words(in_2("5 1 2 4 3 2 5", "5 1 2 4 3 2 10"),
               {"line 30", "line 5 has a node that belongs to no cell"});
  expect_words(in_2("5 1 2 4 3 2 5", "5 1 2 4 3 1 5"),
               {"line 30", "from node 1 to node 5 is no edge"});
  expect_words(in_2("2 1 2 2 1 1 2", "2 15 2 1 1 3"),
               {"line 27", "a second node for the point 'P'"});
  // A third cell on the same side of the middle as the second one.
  expect_words(message_of_text<2>(with(with(version_2, "10 7 7 0", "10 3 2 0"),
                                       "9 3 2 7 2 2 5 6 3",
                                       "9 3 2 7 2 2 5 10 3")),
               {"line 34", "elements 8 and 9 overlap", "nodes"});
  // The second cell has nodes of its own at (1,0), (1,1): not connected.
  const std::string apart =
    with(with(with(with(version_2, "10 7 7 0", "10 1 0 0\n11 1 1 0"),
                   "\n7\n1 0 0 0",
                   "\n8\n1 0 0 0"),
              "8 3 2 6 2 2 5 6 3",
              "8 3 2 6 2 10 11 6 3"),
         "9 3 2 7 2 2 5 6 3",
         "9 3 2 7 2 10 11 6 3");
  const std::string connected_lines =
    with(apart, "4 1 2 2 2 2 3", "4 1 2 2 2 10 3");
  expect_words(message_of_text<2>(connected_lines),
               {"nodes 2 and 10 lie at the same place (1, 0)", "Coherence"});
  expect_words(make<2>("file",
                       {{"File name", "wrong.msh"},
                        {"Allow touching parts", "true"}})
                 .description,
               {"2 separate parts"});
  // Now its left edge is longer than that of the first: a node hangs on it.
  expect_words(message_of_text<2>(with(connected_lines,
                                       "10 1 0 0\n11 1 1 0",
                                       "10 1 -0.5 0\n11 1 1.5 0")),
               {"node 2 (1, 0) hangs on the edge between nodes 10 and 11"});
}
