# The rooms, lowest first, and the one table of who may include whom. A room is the folder src/NAME
# (with include/rift/NAME for the headers that other rooms use) and the library of that name; it may
# include its own headers, those of its ROOMS, and of its OPTIONS only the headers that hold options
# (options.hpp, *_options.hpp). Nothing is transitive. tests/architecture holds every #include to
# this table, and docs/rooms.md is made from it.

rift_room(limits
  PRIVATE_LIBRARIES fmt::fmt)
rift_room(statistics
  LIBRARIES Boost::headers PRIVATE_LIBRARIES Eigen3::Eigen fmt::fmt)
rift_room(files ROOMS limits
  PRIVATE_LIBRARIES fmt::fmt)
rift_room(geometry
  LIBRARIES Eigen3::Eigen)
rift_room(yaml ROOMS limits
  LIBRARIES fmt::fmt PRIVATE_LIBRARIES yaml-cpp)
rift_room(flags ROOMS files yaml
  LIBRARIES CLI11::CLI11 fmt::fmt)
rift_room(terminal ROOMS yaml
  PRIVATE_LIBRARIES fmt::fmt)
rift_room(trajectory ROOMS geometry limits statistics
  LIBRARIES fmt::fmt PRIVATE_LIBRARIES FastFloat::fast_float)
rift_room(control ROOMS geometry
  LIBRARIES fmt::fmt)
rift_room(trial ROOMS control geometry statistics trajectory
  LIBRARIES fmt::fmt)
rift_room(gap ROOMS geometry statistics trajectory
  LIBRARIES fmt::fmt)
rift_room(odometry ROOMS control gap geometry statistics trajectory
  LIBRARIES Eigen3::Eigen PRIVATE_LIBRARIES fmt::fmt)
rift_room(search ROOMS statistics
  PRIVATE_LIBRARIES Boost::headers Eigen3::Eigen fmt::fmt PkgConfig::NLOPT)
rift_room(simulation ROOMS geometry limits statistics trial
  LIBRARIES fmt::fmt PRIVATE_LIBRARIES PkgConfig::ODE PNG::PNG)
rift_room(vision/camera ROOMS files statistics yaml
  LIBRARIES Eigen3::Eigen opencv_core opencv_imgproc opencv_calib3d
  PRIVATE_LIBRARIES fmt::fmt opencv_imgcodecs opencv_videoio CURL::libcurl PkgConfig::JPEG)
rift_room(vision/calibration ROOMS limits statistics vision/camera
  PRIVATE_LIBRARIES fmt::fmt opencv_imgcodecs)
rift_room(vision/tracking ROOMS geometry statistics vision/camera yaml
  PRIVATE_LIBRARIES fmt::fmt PkgConfig::APRILTAG)
rift_room(vision/rendering ROOMS geometry vision/camera vision/calibration vision/tracking
  PRIVATE_LIBRARIES fmt::fmt opencv_imgcodecs PkgConfig::JPEG)
rift_room(hardware ROOMS control geometry odometry statistics trial vision/camera vision/tracking
  LIBRARIES fmt::fmt Threads::Threads)
rift_room(twin ROOMS control geometry hardware simulation statistics trajectory trial vision/camera vision/rendering
  LIBRARIES fmt::fmt Threads::Threads PRIVATE_LIBRARIES Boost::headers)
rift_room(sweep/run ROOMS files statistics
  LIBRARIES fmt::fmt PRIVATE_LIBRARIES SQLiteCpp sqlite3)
rift_room(experiment ROOMS control limits statistics trajectory yaml
  OPTIONS gap hardware simulation trial twin sweep/run sweep/falsify sweep/calibrate
          vision/camera vision/calibration vision/tracking
  LIBRARIES fmt::fmt Eigen3::Eigen)
rift_room(sweep/falsify ROOMS control experiment files gap odometry search simulation statistics sweep/run trajectory trial yaml
  LIBRARIES fmt::fmt PRIVATE_LIBRARIES nlohmann_json::nlohmann_json)
rift_room(sweep/explain ROOMS experiment odometry search statistics sweep/falsify yaml
  LIBRARIES fmt::fmt PRIVATE_LIBRARIES Eigen3::Eigen)
rift_room(sweep/calibrate ROOMS control experiment gap geometry statistics sweep/falsify sweep/run trajectory trial yaml
  LIBRARIES fmt::fmt PRIVATE_LIBRARIES Eigen3::Eigen Threads::Threads)
rift_room(report/figures ROOMS experiment files gap geometry statistics sweep/calibrate sweep/falsify trajectory
  LIBRARIES fmt::fmt)
rift_room(report/text ROOMS experiment files gap geometry odometry report/figures statistics sweep/calibrate sweep/explain
    sweep/falsify yaml
  LIBRARIES fmt::fmt)
rift_room(report/json ROOMS control experiment gap geometry hardware odometry report/text statistics sweep/calibrate
    sweep/explain sweep/falsify sweep/run trajectory trial vision/calibration vision/rendering
    vision/tracking yaml
  LIBRARIES fmt::fmt nlohmann_json::nlohmann_json)
rift_room(report/page ROOMS experiment files odometry report/figures report/text statistics sweep/explain
    sweep/falsify
  LIBRARIES fmt::fmt PRIVATE_LIBRARIES nlohmann_json::nlohmann_json)
rift_room(sessions/sweep ROOMS experiment files report/figures report/json report/page report/text
    statistics sweep/calibrate sweep/explain sweep/falsify sweep/run yaml
  LIBRARIES fmt::fmt PRIVATE_LIBRARIES Boost::headers nlohmann_json::nlohmann_json)
rift_room(view ROOMS control geometry trajectory trial vision/calibration vision/camera vision/tracking
  OPTIONS simulation
  LIBRARIES fmt::fmt Eigen3::Eigen opencv_core
  PRIVATE_LIBRARIES opencv_imgproc opencv_highgui opencv_videoio PkgConfig::XCB)
rift_room(sessions/gap ROOMS experiment files gap odometry sweep/falsify trajectory
  LIBRARIES fmt::fmt)
rift_room(sessions/drive ROOMS experiment files geometry hardware odometry report/json sessions/sweep
    sweep/falsify trajectory twin view vision/camera vision/tracking
  LIBRARIES fmt::fmt PRIVATE_LIBRARIES nlohmann_json::nlohmann_json)
rift_room(sessions/track ROOMS experiment files report/json statistics trajectory view
    vision/calibration vision/camera vision/tracking
  LIBRARIES fmt::fmt)
rift_room(sessions/simulate ROOMS experiment files odometry report/figures report/json sweep/falsify
    trajectory trial twin view vision/camera yaml
  LIBRARIES fmt::fmt PRIVATE_LIBRARIES nlohmann_json::nlohmann_json)
rift_room(commands/arguments ROOMS experiment files flags sweep/falsify terminal trajectory
  LIBRARIES CLI11::CLI11 fmt::fmt)
rift_room(commands/sweep ROOMS commands/arguments experiment files report/json report/page
    report/text sessions/sweep sweep/falsify sweep/run terminal
  LIBRARIES fmt::fmt)
rift_room(commands/drive ROOMS commands/arguments commands/sweep files hardware report/json
    sessions/drive sessions/sweep terminal view
  LIBRARIES fmt::fmt)
rift_room(commands/track ROOMS commands/arguments experiment files report/json sessions/track terminal
    trajectory vision/calibration vision/camera vision/rendering vision/tracking
  LIBRARIES fmt::fmt)
rift_room(commands ROOMS commands/arguments commands/drive commands/sweep commands/track
    files flags limits report/figures report/json report/text sessions/gap sessions/simulate
    sessions/sweep sweep/falsify terminal trajectory view
  LIBRARIES fmt::fmt)
