#include <gtest/gtest.h>
#include "frsm/tracker.hpp"
TEST(Smoke, IdenticalScan) {
  frsm::Points pts;
  for (int i = 0; i < 180; ++i) {
    double a = (i - 90) * 3.14159265358979 / 180, c = std::cos(a), s = std::sin(a);
    double r = std::min(3.0 / std::max(1e-9, std::abs(c)), s > 0 ? 2.0 / s : 1.3 / std::max(1e-9, -s));
    pts.push_back({r * c, r * s});
  }
  frsm::Tracker t;
  t.reset({1.0, 2.003, 0.4});
  auto m0 = t.track(pts, 0, std::nullopt);
  auto m = t.track(pts, 0.1, std::nullopt);
  std::printf("%s %g %g %g score %g hits %d/%d cov %g %g %g added %ld\n", frsm::to_string(m.status).data(), m.pose.x, m.pose.y, m.pose.theta,
              m.score, m.hits, m.points, std::sqrt(m.covariance(0, 0)), std::sqrt(m.covariance(1, 1)), std::sqrt(m.covariance(2, 2)), t.added_scans());
  EXPECT_EQ(m0.status, frsm::Status::kNoOverlap);
  EXPECT_NEAR(m.pose.x, 1, 1e-3);
}
