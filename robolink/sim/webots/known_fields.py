"""Names of the fields that Webots' nodes have, by node type: others are told of, as Webots does, and ignored.

Source: Webots R2025a, resources/nodes/*.wrl; older spellings that Webots still reads are among them.
"""

from __future__ import annotations

_POSE = "translation rotation scale children translationStep rotationStep"
_SOLID = (
    f"{_POSE} name model description contactMaterial immersionProperties boundingObject physics locked"
    " radarCrossSection recognitionColors linearVelocity angularVelocity"
)
_SURFACE = "name appearance contactMaterial translation rotation"
_MOTOR = (
    "name acceleration consumptionFactor controlPID minPosition maxPosition maxVelocity multiplier sound muscles"
    " triggered"
)
_LENS = "fieldOfView width height near far lens motionBlur noise antiAliasing spherical projection"
_JOINT = "jointParameters device endPoint position"

_FIELDS = {
    "WorldInfo": "info title window gravity CFM ERP physics basicTimeStep FPS optimalThreadCount physicsDisableTime"
    " physicsDisableLinearThreshold physicsDisableAngularThreshold defaultDamping inkEvaporation magneticField"
    " coordinateSystem gpsCoordinateSystem gpsReference lineScale randomSeed contactProperties northDirection fast2d"
    " dragForceScale dragTorqueScale",
    "Group": "children",
    "Pose": _POSE,
    "Transform": _POSE,
    "Shape": "appearance geometry castShadows isPickable",
    "Solid": _SOLID,
    "Robot": f"{_SOLID} controller controllerArgs customData supervisor synchronization battery cpuConsumption"
    " selfCollision window remoteControl data showWindow",
    "Physics": "density mass centerOfMass inertiaMatrix damping bounce bounceVelocity coulombFriction"
    " forceDependentSlip orientation",
    "Box": "size",
    "Sphere": "radius subdivision ico",
    "Cylinder": "bottom height radius side top subdivision",
    "Capsule": "bottom height radius side top subdivision",
    "Cone": "bottomRadius height side bottom subdivision",
    "HingeJoint": _JOINT,
    "Hinge2Joint": f"{_JOINT} jointParameters2 device2 position2",
    "SliderJoint": _JOINT,
    "HingeJointParameters": "position axis anchor minStop maxStop springConstant dampingConstant staticFriction"
    " suspensionSpringConstant suspensionDampingConstant suspensionAxis stopERP stopCFM",
    "RotationalMotor": f"{_MOTOR} maxTorque",
    "LinearMotor": f"{_MOTOR} maxForce",
    "PositionSensor": "name noise resolution",
    "Lidar": f"{_SOLID} {_LENS} tiltAngle horizontalResolution verticalFieldOfView numberOfLayers minRange maxRange"
    " type resolution defaultFrequency minFrequency maxFrequency rotatingHead",
    "DistanceSensor": f"{_SOLID} lookupTable type numberOfRays aperture gaussianWidth resolution redColorSensitivity",
    "TouchSensor": f"{_SOLID} type lookupTable resolution",
    "Camera": f"{_SOLID} {_LENS} exposure ambientOcclusionRadius bloomThreshold noiseMaskUrl focus zoom recognition"
    " lensFlare windowPosition pixelSize type colorNoise",
    "RangeFinder": f"{_SOLID} {_LENS} minRange maxRange resolution",
    "PBRAppearance": "baseColor baseColorMap transparency roughness roughnessMap metalness metalnessMap IBLStrength"
    " normalMap normalMapFactor occlusionMap occlusionMapStrength emissiveColor emissiveColorMap emissiveIntensity"
    " textureTransform name",
    "Appearance": "material texture textureTransform name",
    "Material": "ambientIntensity diffuseColor emissiveColor shininess specularColor transparency",
    "Wall": f"{_SURFACE} size",
    "Window": "translation rotation name size windowThickness bottomWallHeight windowHeight frameSize windowSillSize"
    " wallAppearance frameAppearance castShadows",
    "SolidBox": f"{_SURFACE} size enableBoundingObject physics castShadows recognitionColors",
    "WoodenBox": "translation rotation name size mass immersionProperties locked",
    "CardboardBox": "translation rotation name size mass immersionProperties locked",
    "Floor": f"{_SURFACE} size tileSize texture",
    "RectangleArena": "translation rotation name contactMaterial floorSize floorTileSize floorAppearance wallThickness"
    " wallHeight wallAppearance floorTextureUrl wallTextureUrl wallColor wallTileSize",
    "HokuyoUrg04lx": "translation rotation name noise resolution enablePhysics",
    "HokuyoUrg04lxug01": "translation rotation name noise resolution enablePhysics",
    "HokuyoUtm30lx": "translation rotation name noise resolution enablePhysics",
    "RobotisLds01": "translation rotation name noise enablePhysics",
    "SickLms291": "translation rotation name noise resolution enablePhysics",
    "CircleArena": "translation rotation name radius contactMaterial floorAppearance floorTileSize wallThickness"
    " wallHeight wallAppearance subdivision floorTextureUrl wallTextureUrl wallTileSize",
}

KNOWN_FIELDS: dict[str, frozenset[str]] = {kind: frozenset(names.split()) for kind, names in _FIELDS.items()}
"""Field names of each node type that is read here."""
