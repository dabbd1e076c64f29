"""Table of the standard packages' types, by which a bare name is found without importing all of them."""

STANDARD = {
    "msg": {
        "std_msgs": (
            "Bool Byte ByteMultiArray Char ColorRGBA Empty Float32 Float32MultiArray Float64 Float64MultiArray "
            "Header Int16 Int16MultiArray Int32 Int32MultiArray Int64 Int64MultiArray Int8 Int8MultiArray "
            "MultiArrayDimension MultiArrayLayout String UInt16 UInt16MultiArray UInt32 UInt32MultiArray UInt64 "
            "UInt64MultiArray UInt8 UInt8MultiArray"
        ),
        "geometry_msgs": (
            "Accel AccelStamped AccelWithCovariance AccelWithCovarianceStamped Inertia InertiaStamped Point "
            "Point32 PointStamped Polygon PolygonInstance PolygonInstanceStamped PolygonStamped Pose Pose2D "
            "PoseArray PoseStamped PoseWithCovariance PoseWithCovarianceStamped Quaternion QuaternionStamped "
            "Transform TransformStamped Twist TwistStamped TwistWithCovariance TwistWithCovarianceStamped "
            "Vector3 Vector3Stamped VelocityStamped Wrench WrenchStamped"
        ),
        "sensor_msgs": (
            "BatteryState CameraInfo ChannelFloat32 CompressedImage FluidPressure Illuminance Image Imu "
            "JointState Joy JoyFeedback JoyFeedbackArray LaserEcho LaserScan MagneticField MultiDOFJointState "
            "MultiEchoLaserScan NavSatFix NavSatStatus PointCloud PointCloud2 PointField Range RegionOfInterest "
            "RelativeHumidity Temperature TimeReference"
        ),
        "nav_msgs": "Goals GridCells MapMetaData OccupancyGrid Odometry Path",
        "tf2_msgs": "TF2Error TFMessage",
        "builtin_interfaces": "Duration Time",
        "rcl_interfaces": (
            "FloatingPointRange IntegerRange ListParametersResult Log LoggerLevel Parameter ParameterDescriptor "
            "ParameterEvent ParameterEventDescriptors ParameterType ParameterValue SetLoggerLevelsResult "
            "SetParametersResult"
        ),
        "rosgraph_msgs": "Clock",
        "service_msgs": "ServiceEventInfo",
        "unique_identifier_msgs": "UUID",
        "action_msgs": "GoalInfo GoalStatus GoalStatusArray",
        "type_description_interfaces": "Field FieldType IndividualTypeDescription KeyValue TypeDescription TypeSource",
        "ackermann_msgs": "AckermannDrive AckermannDriveStamped",
        "actionlib_msgs": "GoalID GoalStatus GoalStatusArray",
        "apriltag_msgs": "AprilTagDetection AprilTagDetectionArray Point",
        "can_msgs": "Frame",
        "control_msgs": (
            "AdmittanceControllerState BatteryStateArray DynamicInterfaceGroupValues DynamicInterfaceValues "
            "DynamicJointState Float64Values GripperCommand InterfaceValue JointComponentTolerance "
            "JointControllerState JointJog JointTolerance JointTrajectoryControllerState Keys "
            "MecanumDriveControllerState MotionArgument MotionPrimitive MotionPrimitiveSequence MultiDOFCommand "
            "MultiDOFStateStamped PidState SingleDOFState SingleDOFStateStamped SpeedScalingFactor "
            "SteeringControllerStatus VDA5050SafetyState"
        ),
        "controller_manager_msgs": (
            "ChainConnection ControllerManagerActivity ControllerState HardwareComponentState HardwareInterface "
            "NamedLifecycleState"
        ),
        "diagnostic_msgs": "DiagnosticArray DiagnosticStatus KeyValue",
        "example_interfaces": (
            "Bool Byte ByteMultiArray Char Empty Float32 Float32MultiArray Float64 Float64MultiArray Int16 "
            "Int16MultiArray Int32 Int32MultiArray Int64 Int64MultiArray Int8 Int8MultiArray "
            "MultiArrayDimension MultiArrayLayout String UInt16 UInt16MultiArray UInt32 UInt32MultiArray UInt64 "
            "UInt64MultiArray UInt8 UInt8MultiArray WString"
        ),
        "gazebo_msgs": (
            "ContactState ContactsState EntityState LinkState LinkStates ModelState ModelStates "
            "ODEJointProperties ODEPhysics PerformanceMetrics SensorPerformanceMetric WheelSlip WorldState"
        ),
        "geographic_msgs": (
            "BoundingBox GeoPath GeoPoint GeoPointStamped GeoPose GeoPoseStamped GeoPoseWithCovariance "
            "GeoPoseWithCovarianceStamped GeographicMap GeographicMapChanges KeyValue MapFeature RouteNetwork "
            "RoutePath RouteSegment WayPoint"
        ),
        "irobot_create_msgs": (
            "AudioNote AudioNoteVector Button DockStatus HazardDetection HazardDetectionVector InterfaceButtons "
            "IrIntensity IrIntensityVector IrOpcode KidnapStatus LedColor LightringLeds Mouse SlipStatus "
            "StopStatus WheelStatus WheelTicks WheelVels"
        ),
        "lifecycle_msgs": "State Transition TransitionDescription TransitionEvent",
        "map_msgs": "OccupancyGridUpdate PointCloud2Update ProjectedMap ProjectedMapInfo",
        "nav2_msgs": (
            "BehaviorTreeLog BehaviorTreeStatusChange CollisionDetectorState CollisionMonitorState Costmap "
            "CostmapFilterInfo CostmapMetaData CostmapUpdate CriticsStats EdgeCost MissedWaypoint Particle "
            "ParticleCloud Route RouteEdge RouteNode SpeedLimit Trajectory TrajectoryPoint VoxelGrid "
            "WaypointStatus"
        ),
        "octomap_msgs": "Octomap OctomapWithPose",
        "rmw_dds_common": "Gid NodeEntitiesInfo ParticipantEntitiesInfo",
        "ros_gz_interfaces": (
            "Altimeter Contact Contacts Dataframe Entity EntityFactory EntityWrench Float32Array GuiCamera "
            "JointWrench Light MaterialColor ParamVec SensorNoise StringVec TrackVisual VideoRecord "
            "WorldControl WorldReset"
        ),
        "rosapi_msgs": "TypeDef",
        "rosbag2_interfaces": "ReadSplitEvent WriteSplitEvent",
        "rosbridge_msgs": "ConnectedClient ConnectedClients",
        "shape_msgs": "Mesh MeshTriangle Plane SolidPrimitive",
        "statistics_msgs": "MetricsMessage StatisticDataPoint StatisticDataType",
        "stereo_msgs": "DisparityImage",
        "trajectory_msgs": "JointTrajectory JointTrajectoryPoint MultiDOFJointTrajectory MultiDOFJointTrajectoryPoint",
        "turtlebot3_msgs": "SensorState Sound VersionInfo",
        "turtlebot4_msgs": "UserButton UserDisplay UserLed",
        "turtlesim": "Color Pose",
        "vision_msgs": (
            "BoundingBox2D BoundingBox2DArray BoundingBox3D BoundingBox3DArray Classification Detection2D "
            "Detection2DArray Detection3D Detection3DArray LabelInfo ObjectHypothesis ObjectHypothesisWithPose "
            "Point2D Pose2D VisionClass VisionInfo"
        ),
        "visualization_msgs": (
            "ImageMarker InteractiveMarker InteractiveMarkerControl InteractiveMarkerFeedback "
            "InteractiveMarkerInit InteractiveMarkerPose InteractiveMarkerUpdate Marker MarkerArray MenuEntry "
            "MeshFile UVCoordinate"
        ),
        "webots_ros2_msgs": (
            "BoolStamped CameraRecognitionObject CameraRecognitionObjects FloatStamped PenInkProperties "
            "StringStamped UrdfRobot"
        ),
    },
    "srv": {
        "std_srvs": "Empty SetBool Trigger",
        "sensor_msgs": "SetCameraInfo",
        "nav_msgs": "GetMap GetPlan LoadMap SetMap",
        "tf2_msgs": "FrameGraph",
        "action_msgs": "CancelGoal",
        "type_description_interfaces": "GetTypeDescription",
        "composition_interfaces": "ListNodes LoadNode UnloadNode",
        "control_msgs": "QueryCalibrationState QueryTrajectoryState SetOdometry",
        "controller_manager_msgs": (
            "CleanupController ConfigureController ListControllerTypes ListControllers ListHardwareComponents "
            "ListHardwareInterfaces LoadController ReloadControllerLibraries SetHardwareComponentState "
            "SwitchController UnloadController"
        ),
        "diagnostic_msgs": "AddDiagnostics SelfTest",
        "example_interfaces": "AddTwoInts SetBool Trigger",
        "gazebo_msgs": (
            "ApplyBodyWrench ApplyJointEffort ApplyLinkWrench BodyRequest DeleteEntity DeleteLight DeleteModel "
            "GetEntityState GetJointProperties GetLightProperties GetLinkProperties GetLinkState GetModelList "
            "GetModelProperties GetModelState GetPhysicsProperties GetWorldProperties JointRequest LinkRequest "
            "SetEntityState SetJointProperties SetJointTrajectory SetLightProperties SetLinkProperties "
            "SetLinkState SetModelConfiguration SetModelState SetPhysicsProperties SpawnEntity SpawnModel"
        ),
        "geographic_msgs": "GetGeoPath GetGeographicMap GetRoutePlan UpdateGeographicMap",
        "irobot_create_msgs": "EStop ResetPose RobotPower",
        "lifecycle_msgs": "ChangeState GetAvailableStates GetAvailableTransitions GetState",
        "map_msgs": "GetMapROI GetPointMap GetPointMapROI ProjectedMapsInfo SaveMap SetMapProjections",
        "nav2_msgs": (
            "ClearCostmapAroundPose ClearCostmapAroundRobot ClearCostmapExceptRegion ClearEntireCostmap "
            "DynamicEdges GetCost GetCostmap GetCosts IsPathValid LoadMap ManageLifecycleNodes "
            "ReloadDockDatabase SaveMap SetInitialPose SetRouteGraph Toggle"
        ),
        "octomap_msgs": "BoundingBoxQuery GetOctomap",
        "rcl_interfaces": (
            "DescribeParameters GetLoggerLevels GetParameterTypes GetParameters ListParameters SetLoggerLevels "
            "SetParameters SetParametersAtomically"
        ),
        "robot_localization": (
            "FromLL FromLLArray GetState SetDatum SetPose SetUTMZone ToLL ToLLArray ToggleFilterProcessing"
        ),
        "ros_gz_interfaces": "ControlWorld DeleteEntity SetEntityPose SpawnEntity",
        "rosapi_msgs": (
            "ActionType DeleteParam GetActionServers GetParam GetParamNames GetROSVersion GetTime HasParam "
            "Interfaces MessageDetails NodeDetails Nodes Publishers ServiceNode ServiceProviders "
            "ServiceRequestDetails ServiceResponseDetails ServiceType Services ServicesForType SetParam "
            "Subscribers TopicType Topics TopicsAndRawTypes TopicsForType"
        ),
        "rosbag2_interfaces": (
            "Burst GetRate IsPaused Pause Play PlayNext Resume Seek SetRate Snapshot SplitBagfile Stop TogglePaused"
        ),
        "slam_toolbox": (
            "AddSubmap Clear ClearQueue DeserializePoseGraph LoopClosure MergeMaps Pause Reset SaveMap "
            "SerializePoseGraph ToggleInteractive"
        ),
        "topic_tools_interfaces": "DemuxAdd DemuxDelete DemuxList DemuxSelect MuxAdd MuxDelete MuxList MuxSelect",
        "turtlebot3_msgs": "Dqn Goal Sound",
        "turtlesim": "Kill SetPen Spawn TeleportAbsolute TeleportRelative",
        "visualization_msgs": "GetInteractiveMarkers",
        "webots_ros2_msgs": "EmitterSendString GetBool SetString SpawnNodeFromString SpawnUrdfRobot",
    },
    "action": {
        "action_tutorials_interfaces": "Fibonacci",
        "control_msgs": (
            "ExecuteMotionPrimitiveSequence FollowJointTrajectory GripperCommand JointTrajectory "
            "ParallelGripperCommand PointHead SingleJointPosition"
        ),
        "example_interfaces": "Fibonacci",
        "irobot_create_msgs": (
            "AudioNoteSequence Dock DriveArc DriveDistance LedAnimation NavigateToPosition RotateAngle Undock "
            "WallFollow"
        ),
        "nav2_msgs": (
            "AssistedTeleop BackUp ComputeAndTrackRoute ComputePathThroughPoses ComputePathToPose ComputeRoute "
            "DockRobot DriveOnHeading DummyBehavior FollowGPSWaypoints FollowObject FollowPath FollowWaypoints "
            "NavigateThroughPoses NavigateToPose SmoothPath Spin UndockRobot Wait"
        ),
        "tf2_msgs": "LookupTransform",
        "turtlebot3_msgs": "Patrol",
        "turtlesim": "RotateAbsolute",
    },
}
"""Names of the types, by kind and package."""
