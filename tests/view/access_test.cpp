#include "access.hpp"

#include <gtest/gtest.h>

namespace rilo::view {
namespace {

TEST(Access, OnLoopbackNeedsNoTokenButALoopbackName) {
  const Access access(true);
  EXPECT_TRUE(access.token().empty());
  EXPECT_TRUE(access.token_allowed("/ws"));
  for (const char* host :
       {"127.0.0.1:7456", "localhost:7456", "LOCALHOST", "[::1]:7456", "127.0.0.1", "localhost:9000"}) {
    EXPECT_TRUE(access.host_allowed(host)) << host;
  }
  for (const char* host : {"", "evil.example", "evil.example:7456", "localhost.evil.example", "127.0.0.1.evil.example",
                           "192.168.1.5:7456", "0.0.0.0", "[", "[]", ":"}) {
    EXPECT_FALSE(access.host_allowed(host)) << host;
  }
}

TEST(Access, ElsewhereNeedsTheToken) {
  const Access access(false);
  ASSERT_EQ(access.token().size(), 32U);
  EXPECT_NE(Access(false).token(), access.token());
  EXPECT_TRUE(access.token_allowed("/ws?token=" + access.token()));
  EXPECT_TRUE(access.token_allowed("/?a=b&token=" + access.token()));
  std::string wrong = access.token();
  wrong.back() = wrong.back() == '0' ? '1' : '0';
  for (const std::string& target :
       {std::string("/ws"), std::string("/ws?token="), std::string("/ws?token"), "/ws?token=" + wrong,
        "/ws?token=" + access.token() + "0", "/ws?nottoken=" + access.token(), "/" + access.token()}) {
    EXPECT_FALSE(access.token_allowed(target)) << target;
  }
  EXPECT_TRUE(access.host_allowed("192.168.1.5:7456"));
  EXPECT_TRUE(access.host_allowed("localhost"));
  EXPECT_FALSE(access.host_allowed("evil.example"));
}

TEST(Access, OnlyThePageItselfMayConnect) {
  EXPECT_TRUE(Access::origin_allowed("http://127.0.0.1:7456", "127.0.0.1:7456"));
  EXPECT_TRUE(Access::origin_allowed("http://LocalHost:7456", "localhost:7456"));
  for (const char* origin : {"", "null", "http://evil.example", "https://127.0.0.1:7456", "http://127.0.0.1:7457",
                             "http://127.0.0.1:7456.evil.example", "http://127.0.0.1"}) {
    EXPECT_FALSE(Access::origin_allowed(origin, "127.0.0.1:7456")) << origin;
  }
  EXPECT_FALSE(Access::origin_allowed("http://", ""));
}

}  // namespace
}  // namespace rilo::view
