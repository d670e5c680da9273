// Main function of the tests. Returns 77 if a case was skipped and none failed, so that ctest
// reports the skip, and 1 if no case ran, so that an outdated filter fails.

#ifdef FENESTRA_TEST_SANDBOX
#include "io/Sandbox.h"
#endif

#include <gtest/gtest.h>

#ifdef FENESTRA_TEST_WIDGETS
#include <QApplication>
using Application = QApplication;
#elif defined(FENESTRA_TEST_QT)
#include <QCoreApplication>
using Application = QCoreApplication;
#endif

int main(int argc, char** argv) {
#ifdef FENESTRA_TEST_SANDBOX
  fenestra::core::serveSandbox(argc, argv); // this executable is also the sandboxed reader process
#endif
  ::testing::InitGoogleTest(&argc, argv);
#ifdef FENESTRA_TEST_WIDGETS
  if (!qEnvironmentVariableIsSet("QT_QPA_PLATFORM"))
    qputenv("QT_QPA_PLATFORM", "offscreen");
#endif
#ifdef FENESTRA_TEST_QT
  const Application application(argc, argv);
#endif
  if (RUN_ALL_TESTS() != 0)
    return 1;
  const auto& all = *::testing::UnitTest::GetInstance();
  if (all.test_to_run_count() == 0)
    return 1;
  return all.skipped_test_count() > 0 ? 77 : 0;
}
