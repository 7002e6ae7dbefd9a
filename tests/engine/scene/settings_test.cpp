#include "engine/scene/settings.hpp"

#include <gtest/gtest.h>

namespace psygen::scene {
namespace {

TEST(SceneSettings, ParadigmsHaveNamesThatReadBack) {
  for (const Paradigm paradigm : {Paradigm::kParallelLazyAmplification,
                                  Paradigm::kDataAmplification, Paradigm::kLazyEvaluation}) {
    const auto read = paradigm_from(to_string(paradigm));
    ASSERT_TRUE(read);
    EXPECT_EQ(*read, paradigm);
  }
}

TEST(SceneSettings, AnUnknownParadigmIsRejectedAndTheKnownOnesAreListed) {
  const auto read = paradigm_from("eager");
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, core::ErrorCode::kInvalidArgument);
  for (const char* word : {"eager", "pla", "amplify", "lazy"}) {
    EXPECT_NE(read.error().message.find(word), std::string::npos);
  }
}

TEST(SceneSettings, ModesOfPlpHaveNamesAndOthersAreRejected) {
  for (const auto mode : {visibility::PlpMode::kLayers, visibility::PlpMode::kSolidity})
    EXPECT_EQ(*plp_mode_from(to_string(mode)), mode);
  EXPECT_FALSE(plp_mode_from("nonsense"));
}

}  // namespace
}  // namespace psygen::scene
