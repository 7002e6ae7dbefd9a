// A map of the world around the camera: each node of the quadtree as a coloured square. A tool tip
// explains the state of a node. Reads the scene, changes nothing. Main thread.
#pragma once

#include <QPixmap>
#include <QWidget>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "editor/view/river_map.hpp"
#include "engine/core/coordinates.hpp"
#include "engine/synthesis/mesh_key.hpp"
#include "engine/visibility/quadtree.hpp"

class QPainter;

namespace psygen::scene {
class Scene;
}

namespace psygen::editor {

class WorldView;

// The quantity that the colours show.
enum class MapColour { kState, kLevel, kLayer, kCost, kAge };

// North (−z) is up.
class CacheMap final : public QWidget {
  Q_OBJECT

 public:
  // A node as the map shows it.
  struct Cell {
    visibility::NodeCoord at;
    double x_m = 0, z_m = 0, size_m = 0;  // from the camera: the corner, and the side
    bool in_view = false, drawn = false, stale = false, requested = false, failed = false;
    int level_drawn = 0, layer = 0;
    std::uint32_t lacking = 0;
    double cost_s = 0, deadline_s = 0;
    double age_s = -1;  // of the mesh of its ground; below 0: unknown
  };
  explicit CacheMap(QWidget* parent = nullptr);
  // Records new meshes, for their ages. To be called a few times a second, also while the map is
  // hidden.
  void note(const scene::Scene& scene);
  // Shows the nodes of the scene; after note().
  void show(const scene::Scene& scene);
  // Shows given nodes, coarse ones first; yaw and field of view in radians.
  void show_cells(std::vector<Cell> cells, double yaw, double horizontal_fov);
  // Draws channels, shores and divides over the nodes; null: none. `block_m`: side of a block.
  void show_rivers(std::shared_ptr<const RiverMap> rivers, const core::WorldPosition& camera,
                   double block_m);
  void set_colour(MapColour colour);
  // Half the smaller side of the map.
  void set_radius_m(double radius_m);
  QSize sizeHint() const override { return {280, 280}; }

 protected:
  void paintEvent(QPaintEvent* event) override;
  bool event(QEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;

 private:
  QColor colour_of(const Cell& cell) const;
  QString tool_tip_of(const Cell& cell) const;
  const Cell* cell_at(QPointF place) const;
  double pixels_per_m() const;
  void paint_rivers(QPainter& painter);
  void draw_rivers(QPointF corner, QSize wide);

  struct KnownMesh {
    synthesis::MeshHandle mesh;
    double since_s = 0;  // the real clock of the scene
  };
  std::vector<Cell> cells_;                             // coarse ones first
  std::unordered_map<std::uint64_t, KnownMesh> known_;  // by entity of a node
  std::shared_ptr<const RiverMap> rivers_;
  glm::dvec3 rivers_from_camera_m_{0.0};
  // The rivers as they were drawn last, with a margin for a camera that moves.
  struct RiverPicture {
    std::shared_ptr<const RiverMap> rivers;
    double scale = 0;  // pixels per metre
    QPointF corner;    // the map's, in pixels from the camera
    QPixmap pixels;
  };
  RiverPicture picture_;
  double radius_m_ = 1500, yaw_ = 0, fov_ = 0.9;
  MapColour colour_ = MapColour::kState;
};

// Makes the panel "Cache map": the map of the view's cache, a list of colourings, and their legend.
// It updates the map four times a second. The view outlives the panel.
QWidget* make_cache_map_panel(WorldView& view);

}  // namespace psygen::editor
