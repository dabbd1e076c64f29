"""Table of the standard packages' types, by which a bare name is found without importing all of them."""

STANDARD = {
    "msg": {
        "std_msgs": (
            "Bool Byte ByteMultiArray Char ColorRGBA Empty Float32 Float32MultiArray Float64 "
            "Float64MultiArray Header Int16 Int16MultiArray Int32 Int32MultiArray Int64 Int64MultiArray "
            "Int8 Int8MultiArray MultiArrayDimension MultiArrayLayout String UInt16 UInt16MultiArray "
            "UInt32 UInt32MultiArray UInt64 UInt64MultiArray UInt8 UInt8MultiArray"
        ),
        "geometry_msgs": (
            "Accel AccelStamped AccelWithCovariance AccelWithCovarianceStamped Inertia InertiaStamped "
            "Point Point32 PointStamped Polygon PolygonInstance PolygonInstanceStamped PolygonStamped "
            "Pose Pose2D PoseArray PoseStamped PoseWithCovariance PoseWithCovarianceStamped Quaternion "
            "QuaternionStamped Transform TransformStamped Twist TwistStamped TwistWithCovariance "
            "TwistWithCovarianceStamped Vector3 Vector3Stamped VelocityStamped Wrench WrenchStamped"
        ),
        "sensor_msgs": (
            "BatteryState CameraInfo ChannelFloat32 CompressedImage FluidPressure Illuminance Image Imu "
            "JointState Joy JoyFeedback JoyFeedbackArray LaserEcho LaserScan MagneticField "
            "MultiDOFJointState MultiEchoLaserScan NavSatFix NavSatStatus PointCloud PointCloud2 "
            "PointField Range RegionOfInterest RelativeHumidity Temperature TimeReference"
        ),
        "nav_msgs": "GridCells MapMetaData OccupancyGrid Odometry Path",
        "tf2_msgs": "TF2Error TFMessage",
        "builtin_interfaces": "Duration Time",
        "rcl_interfaces": (
            "FloatingPointRange IntegerRange ListParametersResult Log LoggerLevel Parameter "
            "ParameterDescriptor ParameterEvent ParameterEventDescriptors ParameterType ParameterValue "
            "SetLoggerLevelsResult SetParametersResult"
        ),
        "rosgraph_msgs": "Clock",
        "service_msgs": "ServiceEventInfo",
        "unique_identifier_msgs": "UUID",
        "action_msgs": "GoalInfo GoalStatus GoalStatusArray",
        "type_description_interfaces": "Field FieldType IndividualTypeDescription KeyValue TypeDescription TypeSource",
        "ackermann_msgs": "AckermannDrive AckermannDriveStamped",
        "actionlib_msgs": "GoalID GoalStatus GoalStatusArray",
        "control_msgs": (
            "AdmittanceControllerState BatteryStateArray DynamicInterfaceGroupValues "
            "DynamicInterfaceValues DynamicJointState Float64Values GripperCommand InterfaceValue "
            "JointComponentTolerance JointControllerState JointJog JointTolerance "
            "JointTrajectoryControllerState Keys MecanumDriveControllerState MotionArgument "
            "MotionPrimitive MotionPrimitiveSequence MultiDOFCommand MultiDOFStateStamped PidState "
            "SingleDOFState SingleDOFStateStamped SpeedScalingFactor SteeringControllerStatus "
            "VDA5050SafetyState"
        ),
        "diagnostic_msgs": "DiagnosticArray DiagnosticStatus KeyValue",
        "example_interfaces": (
            "Bool Byte ByteMultiArray Char Empty Float32 Float32MultiArray Float64 Float64MultiArray "
            "Int16 Int16MultiArray Int32 Int32MultiArray Int64 Int64MultiArray Int8 Int8MultiArray "
            "MultiArrayDimension MultiArrayLayout String UInt16 UInt16MultiArray UInt32 "
            "UInt32MultiArray UInt64 UInt64MultiArray UInt8 UInt8MultiArray WString"
        ),
        "lifecycle_msgs": "State Transition TransitionDescription TransitionEvent",
        "nav2_msgs": "MissedWaypoint",
        "rmw_dds_common": "Gid NodeEntitiesInfo ParticipantEntitiesInfo",
        "rosbag2_interfaces": "ReadSplitEvent WriteSplitEvent",
        "shape_msgs": "Mesh MeshTriangle Plane SolidPrimitive",
        "statistics_msgs": "MetricsMessage StatisticDataPoint StatisticDataType",
        "stereo_msgs": "DisparityImage",
        "trajectory_msgs": "JointTrajectory JointTrajectoryPoint MultiDOFJointTrajectory MultiDOFJointTrajectoryPoint",
        "turtlesim": "Color Pose",
        "visualization_msgs": (
            "ImageMarker InteractiveMarker InteractiveMarkerControl InteractiveMarkerFeedback "
            "InteractiveMarkerInit InteractiveMarkerPose InteractiveMarkerUpdate Marker MarkerArray "
            "MenuEntry MeshFile UVCoordinate"
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
        "diagnostic_msgs": "AddDiagnostics SelfTest",
        "example_interfaces": "AddTwoInts SetBool Trigger",
        "lifecycle_msgs": "ChangeState GetAvailableStates GetAvailableTransitions GetState",
        "rcl_interfaces": (
            "DescribeParameters GetLoggerLevels GetParameterTypes GetParameters ListParameters "
            "SetLoggerLevels SetParameters SetParametersAtomically"
        ),
        "rosbag2_interfaces": (
            "Burst GetRate IsPaused Pause Play PlayNext Resume Seek SetRate Snapshot SplitBagfile Stop TogglePaused"
        ),
        "turtlesim": "Kill SetPen Spawn TeleportAbsolute TeleportRelative",
        "visualization_msgs": "GetInteractiveMarkers",
    },
    "action": {
        "action_tutorials_interfaces": "Fibonacci",
        "control_msgs": (
            "ExecuteMotionPrimitiveSequence FollowJointTrajectory GripperCommand JointTrajectory "
            "ParallelGripperCommand PointHead SingleJointPosition"
        ),
        "example_interfaces": "Fibonacci",
        "nav2_msgs": (
            "BackUp ComputePathThroughPoses ComputePathToPose DriveOnHeading FollowPath FollowWaypoints "
            "NavigateThroughPoses NavigateToPose Spin Wait"
        ),
        "tf2_msgs": "LookupTransform",
        "turtlesim": "RotateAbsolute",
    },
}
"""Names of the types, by kind and package."""
