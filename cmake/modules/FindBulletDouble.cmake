# Bullet in double precision: target Bullet::Double. Debian's libbullet-dev has it beside the one in
# single precision; both have the same symbols, so a program uses one of them.
find_path(BulletDouble_INCLUDE_DIR btBulletDynamicsCommon.h PATH_SUFFIXES bullet)
set(BulletDouble_parts)
foreach(part BulletDynamics BulletCollision LinearMath)
  find_library(BulletDouble_${part} ${part}-float64)
  mark_as_advanced(BulletDouble_${part})
  list(APPEND BulletDouble_parts BulletDouble_${part})
endforeach()
mark_as_advanced(BulletDouble_INCLUDE_DIR)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(BulletDouble
  REQUIRED_VARS BulletDouble_INCLUDE_DIR ${BulletDouble_parts})
if(BulletDouble_FOUND AND NOT TARGET Bullet::Double)
  add_library(Bullet::Double INTERFACE IMPORTED)
  set_target_properties(Bullet::Double PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${BulletDouble_INCLUDE_DIR}"
    INTERFACE_COMPILE_DEFINITIONS BT_USE_DOUBLE_PRECISION
    INTERFACE_LINK_LIBRARIES
      "${BulletDouble_BulletDynamics};${BulletDouble_BulletCollision};${BulletDouble_LinearMath}")
endif()
