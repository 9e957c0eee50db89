#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "figures/profile.hpp"

namespace talus::figures {
namespace {

TEST(Layout, AspectIsEqualAndPanelsNeitherOverlapNorLeaveTheCanvas) {
  for (const Box view : {Box{{-1, -2}, {40, 15}}, Box{{0, 0}, {200, 30}}, Box{{0, 0}, {1, 5}}}) {
    for (std::size_t n = 1; n <= 9; ++n) {
      const Layout layout = profile_layout(n, view, 30);
      ASSERT_EQ(layout.panels.size(), n);
      for (std::size_t i = 0; i < n; ++i) {
        const Panel& p = layout.panels[i];
        EXPECT_NEAR(p.width() / view.width(), layout.metre, 1e-9);
        EXPECT_NEAR(p.height() / view.height(), layout.metre, 1e-9);
        EXPECT_GT(p.left, 0);
        EXPECT_LT(p.right, layout.canvas.width);
        EXPECT_LT(p.bottom, layout.canvas.height);
        for (std::size_t j = 0; j < i; ++j) {
          const Panel& q = layout.panels[j];
          EXPECT_TRUE(q.right < p.left || q.bottom < p.top) << i << " over " << j;
        }
      }
    }
  }
}

TEST(Layout, NotesAreWrappedAndKeepEveryWord) {
  const Canvas canvas{300, 200};
  const std::string first =
      "doubtful: the slide moved at 44.7 % of sqrt(g H) when the run ended, so its run-out is not final";
  const std::vector<std::string> lines = note_lines(first + "\ninvalid: too fast\n", canvas);
  ASSERT_GT(lines.size(), 2u);
  std::string joined = lines.front();
  for (std::size_t k = 1; k + 1 < lines.size(); ++k) joined += " " + lines[k];
  EXPECT_EQ(joined, first);
  EXPECT_EQ(lines.back(), "invalid: too fast");
  for (const std::string& line : lines) EXPECT_LE(line.size(), note_characters(canvas));
  EXPECT_TRUE(note_lines("", canvas).empty());
}

}  // namespace
}  // namespace talus::figures
