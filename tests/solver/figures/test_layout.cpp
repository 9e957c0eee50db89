#include <gtest/gtest.h>

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

}  // namespace
}  // namespace talus::figures
