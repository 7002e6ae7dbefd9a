// Shows the effect of edits: view and properties follow the document, and the predicted costs
// follow both. Costly edits ask first. Main thread; a CostWorker computes the costs.
#pragma once

#include <QElapsedTimer>
#include <QObject>
#include <QTimer>

#include "editor/cost/edit_cost.hpp"
#include "editor/cost/world_impact.hpp"
#include "editor/shell/main_window.hpp"

namespace psygen::editor {

class CostWorker;
struct BlockCost;

// One per window.
class EditFeedback final : public QObject {
  Q_OBJECT

 public:
  // Edits beyond `limits` ask first.
  EditFeedback(const EditorContext& context, RegisterModels register_models, CostLimits limits);

  // Edits between true and false are one undo step. Their images are coarse, and their impact
  // counts from the world at the start of the drag.
  void set_dragging(bool on);

 Q_SIGNALS:
  // The mean cost of a block, and the number of blocks of the world (0: endless).
  void block_cost_changed(const psygen::editor::BlockCost& cost, double blocks);

 private:
  QString confirmation_for(const ParsedWorld& before, const ParsedWorld& after);
  void on_document_changed(Change what);
  void read_scene();
  void request_costs();

  const EditorContext context_;
  CostLimits limits_;
  CostWorker* worker_;
  QTimer delay_;         // from the last change to the request of new costs
  int delay_count_ = 0;  // times that the request waited for meshes of the view
  // Contents of the cache and cost model of the scene, as last read.
  CacheContents contents_;
  std::shared_ptr<const synthesis::CostModel> learnt_;
  QElapsedTimer since_read_;
  ParsedWorldPtr drag_start_;   // null: no drag
  ParsedWorldPtr last_parsed_;  // before the last change
  decltype(world::Palette::images) shown_images_;
};

}  // namespace psygen::editor
