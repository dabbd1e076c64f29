"""Which standard package has which types: what lets a bare name be found without importing all of them."""

STANDARD = {
    "msg": {
        "std_msgs": (
            "Bool Byte ByteMultiArray Char ColorRGBA Empty Float32 Float32MultiArray Float64 "
            "Float64MultiArray Header Int16 Int16MultiArray Int32 Int32MultiArray Int64 "
            "Int64MultiArray Int8 Int8MultiArray MultiArrayDimension MultiArrayLayout String "
            "UInt16 UInt16MultiArray UInt32 UInt32MultiArray UInt64 UInt64MultiArray UInt8 "
            "UInt8MultiArray"
        ),
        "geometry_msgs": (
            "Accel AccelStamped AccelWithCovariance AccelWithCovarianceStamped Inertia "
            "InertiaStamped Point Point32 PointStamped Polygon PolygonInstance "
            "PolygonInstanceStamped PolygonStamped Pose Pose2D PoseArray PoseStamped "
            "PoseWithCovariance PoseWithCovarianceStamped Quaternion QuaternionStamped Transform "
            "TransformStamped Twist TwistStamped TwistWithCovariance TwistWithCovarianceStamped "
            "Vector3 Vector3Stamped VelocityStamped Wrench WrenchStamped"
        ),
        "sensor_msgs": (
            "BatteryState CameraInfo ChannelFloat32 CompressedImage FluidPressure Illuminance "
            "Image Imu JointState Joy JoyFeedback JoyFeedbackArray LaserEcho LaserScan "
            "MagneticField MultiDOFJointState MultiEchoLaserScan NavSatFix NavSatStatus "
            "PointCloud PointCloud2 PointField Range RegionOfInterest RelativeHumidity "
            "Temperature TimeReference"
        ),
        "nav_msgs": "GridCells MapMetaData OccupancyGrid Odometry Path",
        "tf2_msgs": "TF2Error TFMessage",
        "builtin_interfaces": "Duration Time",
        "rcl_interfaces": (
            "FloatingPointRange IntegerRange ListParametersResult Log LoggerLevel Parameter "
            "ParameterDescriptor ParameterEvent ParameterEventDescriptors ParameterType "
            "ParameterValue SetLoggerLevelsResult SetParametersResult"
        ),
        "rosgraph_msgs": "Clock",
        "service_msgs": "ServiceEventInfo",
    },
    "srv": {
        "std_srvs": "Empty SetBool Trigger",
        "sensor_msgs": "SetCameraInfo",
        "nav_msgs": "GetMap GetPlan LoadMap SetMap",
        "tf2_msgs": "FrameGraph",
    },
    "action": {},
}
"""Kind to package to the names of its types."""
