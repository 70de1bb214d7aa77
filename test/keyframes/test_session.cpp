#include <gtest/gtest.h>

#include "object_modelling/keyframes/session.h"

namespace object_modelling::keyframes
{
TEST(SessionId, TakesLettersDigitsAndThreeSigns)
{
  for (const char* id : { "a", "Z9", "0", "cereal_box.2024-05-01_a", "_hidden" })
    EXPECT_TRUE(isValidId(id)) << id;
  EXPECT_TRUE(isValidId(std::string(64, 'x')));
}

TEST(SessionId, RefusesWhatFilesTopicsOrSqlWouldMisread)
{
  for (const char* id : { "", ".", "..", ".hidden", "-flag", "../x", "a/b", "a b", "a\n", "'; DROP TABLE sessions; --",
                          "caf\xc3\xa9", "a:b", "a\\b" })
    EXPECT_FALSE(isValidId(id)) << id;
  EXPECT_FALSE(isValidId(std::string(65, 'x')));
  EXPECT_FALSE(isValidId(std::string("a\0b", 3)));
}

}  // namespace object_modelling::keyframes
