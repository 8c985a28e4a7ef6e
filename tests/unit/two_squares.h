// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_tests_unit_two_squares_h
#define alveolus_tests_unit_two_squares_h

// The text of a small mesh in both formats, and how to change it.
#include <gtest/gtest.h>

#include <string>

namespace alveolus::bench
{
  /** Replace the only occurrence of @p old. */
  inline std::string
  with(std::string text, const std::string &old, const std::string &replacement)
  {
    const std::size_t position = text.find(old);
    EXPECT_NE(position, std::string::npos) << old;
    if (position != std::string::npos)
      text.replace(position, old.size(), replacement);
    return text;
  }

  /**
   * Two squares [0,1]x[0,1] ("soft") and [1,2]x[0,1] ("hard"), both "body",
   * with the curves "bottom" (two entities), "start" (its first half), the
   * inner curve "middle" and the point P at (1, 0). The second cell is
   * clockwise; node 10 is unused.
   */
  inline const std::string version_2 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
7
0 1 "P"
1 2 "bottom"
1 3 "start"
1 4 "middle"
2 5 "soft"
2 6 "hard"
2 7 "body"
$EndPhysicalNames
$Nodes
7
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
10 7 7 0
$EndNodes
$Elements
9
1 15 2 1 1 2
2 1 2 2 1 1 2
3 1 2 3 1 2 1
4 1 2 2 2 2 3
5 1 2 4 3 2 5
6 3 2 5 1 1 2 5 4
7 3 2 7 1 1 2 5 4
8 3 2 6 2 2 5 6 3
9 3 2 7 2 2 5 6 3
$EndElements
)";

  /** The same mesh in format 4.1, nodes in other blocks and order. */
  inline const std::string version_4 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
7
0 1 "P"
1 2 "bottom"
1 3 "start"
1 4 "middle"
2 5 "soft"
2 6 "hard"
2 7 "body"
$EndPhysicalNames
$Entities
1 3 2 0
1 1 0 0 1 1
1 0 0 0 1 0 0 2 2 3 2 1 -2
2 1 0 0 2 0 0 1 2 2 1 -2
3 1 0 0 1 1 0 1 4 2 1 -2
1 0 0 0 1 1 0 2 5 7 1 1
2 1 0 0 2 1 0 2 6 7 1 2
$EndEntities
$Nodes
2 7 1 10
1 1 0 2
10
2
7 7 0
1 0 0
2 1 0 5
1
3
4
5
6
0 0 0
2 0 0
0 1 0
1 1 0
2 1 0
$EndNodes
$Elements
6 6 1 6
0 1 15 1
1 2
1 1 1 1
2 1 2
1 2 1 1
3 2 3
1 3 1 1
4 2 5
2 1 3 1
5 1 2 5 4
2 2 3 1
6 2 5 6 3
$EndElements
)";
} // namespace alveolus::bench

#endif
