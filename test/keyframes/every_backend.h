#pragma once

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "../../src/keyframes/sql_dialect.h"
#include "store_fixtures.h"

namespace object_modelling::keyframes
{
/// A test that runs on SQLite and on PostgreSQL, on a database of its own.
class OnEveryBackend : public ::testing::TestWithParam<std::string>
{
protected:
  void SetUp() override;
  /// Of connection_.
  std::unique_ptr<SqlDialect> dialect() const;

  TemporaryFolder folder_;
  std::string connection_;  ///< for openSqlStore(); empty where the test is skipped
};
}  // namespace object_modelling::keyframes

/// Runs the tests of a suite derived from OnEveryBackend.
#define INSTANTIATE_ON_EVERY_BACKEND(suite)                                            \
  INSTANTIATE_TEST_SUITE_P(Backends, suite, ::testing::Values("sqlite", "postgresql"), \
                           [](const auto& backend) { return backend.param; })
