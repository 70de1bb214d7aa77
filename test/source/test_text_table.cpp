#include "text_table.h"

#include <gtest/gtest.h>

#include "object_modelling/base/atomic_file.h"
#include "support/temp_dir.h"

namespace object_modelling::source
{
namespace
{
std::vector<TextRow> parse(const std::string& text)
{
  const test_support::TempDir dir;
  base::writeTextFile(dir.path("list.txt"), text);
  return readTextTable(dir.path("list.txt"));
}

TEST(TextTable, CommentsBlanksAndLineEndings)
{
  const std::vector<TextRow> rows = parse("# head\r\n\r\n1.5 rgb/a.png\r\n  2\t rgb/b.png  # note\n\n3 c");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].words, (std::vector<std::string>{ "1.5", "rgb/a.png" }));
  EXPECT_EQ(rows[1].words, (std::vector<std::string>{ "2", "rgb/b.png" }));
  EXPECT_EQ(rows[2].words, (std::vector<std::string>{ "3", "c" }));
  EXPECT_NE(rows[1].where.find("list.txt:4"), std::string::npos);
}

TEST(TextTable, EmptyFileHasNoRows)
{
  EXPECT_TRUE(parse("").empty());
}

TEST(TextTable, NumbersAreWholeWordsAndFinite)
{
  const TextRow row = parse("1305031233.861613 -1e-3 1.5x nan inf 0x10 1,5 1e999").front();
  EXPECT_DOUBLE_EQ(row.number(0), 1305031233.861613);
  EXPECT_DOUBLE_EQ(row.number(1), -1e-3);
  for (std::size_t i = 2; i < row.words.size(); ++i)
    EXPECT_THROW(row.number(i), base::Error) << row.words[i];
}

TEST(TextTable, TooFewWordsNameTheLine)
{
  try
  {
    parse("\n1.0\n").front().requireWords(2, "stamp path");
    FAIL() << "accepted";
  }
  catch (const base::Error& error)
  {
    EXPECT_EQ(error.code(), base::StatusCode::BAD_INPUT);
    EXPECT_NE(std::string(error.what()).find("list.txt:2: has 1 words, expected \"stamp path\""), std::string::npos);
  }
}

}  // namespace
}  // namespace object_modelling::source
