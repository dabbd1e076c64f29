"""The robot's surroundings and its battery. A variance of 0 stands for one that is unknown."""

from typing import ClassVar

from robolink.interfaces.std_msgs.msg import Header
from robolink.message import Message, Sequence, float32, float64, string, uint8


class FluidPressure(Message):
    """The absolute pressure of air or water, in pascals, and its variance in Pa²."""

    header: Header
    fluid_pressure: float64
    variance: float64


class Illuminance(Message):
    """The brightness of light that falls on the sensor along its x axis, in lux, and its variance in lux²."""

    header: Header
    illuminance: float64
    variance: float64


class RelativeHumidity(Message):
    """The humidity of air, from 0.0 (dry) to 1.0 (saturated), and its variance."""

    header: Header
    relative_humidity: float64
    variance: float64


class Temperature(Message):
    """A temperature in degrees Celsius, and its variance."""

    header: Header
    temperature: float64
    variance: float64


class BatteryState(Message):
    """A battery's charge and health; a number that is not measured is NaN.

    `voltage` is in volts, `temperature` in degrees Celsius, `current` in amperes (negative while
    discharging), `charge` (now), `capacity` (when last full) and `design_capacity` in ampere hours,
    `percentage` from 0.0 to 1.0. `cell_voltage` and `cell_temperature` have an element for each cell;
    `location` is the slot.
    """

    POWER_SUPPLY_STATUS_UNKNOWN: ClassVar[uint8] = 0
    POWER_SUPPLY_STATUS_CHARGING: ClassVar[uint8] = 1
    POWER_SUPPLY_STATUS_DISCHARGING: ClassVar[uint8] = 2
    POWER_SUPPLY_STATUS_NOT_CHARGING: ClassVar[uint8] = 3
    POWER_SUPPLY_STATUS_FULL: ClassVar[uint8] = 4
    POWER_SUPPLY_HEALTH_UNKNOWN: ClassVar[uint8] = 0
    POWER_SUPPLY_HEALTH_GOOD: ClassVar[uint8] = 1
    POWER_SUPPLY_HEALTH_OVERHEAT: ClassVar[uint8] = 2
    POWER_SUPPLY_HEALTH_DEAD: ClassVar[uint8] = 3
    POWER_SUPPLY_HEALTH_OVERVOLTAGE: ClassVar[uint8] = 4
    POWER_SUPPLY_HEALTH_UNSPEC_FAILURE: ClassVar[uint8] = 5
    POWER_SUPPLY_HEALTH_COLD: ClassVar[uint8] = 6
    POWER_SUPPLY_HEALTH_WATCHDOG_TIMER_EXPIRE: ClassVar[uint8] = 7
    POWER_SUPPLY_HEALTH_SAFETY_TIMER_EXPIRE: ClassVar[uint8] = 8
    POWER_SUPPLY_TECHNOLOGY_UNKNOWN: ClassVar[uint8] = 0
    POWER_SUPPLY_TECHNOLOGY_NIMH: ClassVar[uint8] = 1
    POWER_SUPPLY_TECHNOLOGY_LION: ClassVar[uint8] = 2
    POWER_SUPPLY_TECHNOLOGY_LIPO: ClassVar[uint8] = 3
    POWER_SUPPLY_TECHNOLOGY_LIFE: ClassVar[uint8] = 4
    POWER_SUPPLY_TECHNOLOGY_NICD: ClassVar[uint8] = 5
    POWER_SUPPLY_TECHNOLOGY_LIMN: ClassVar[uint8] = 6
    POWER_SUPPLY_TECHNOLOGY_TERNARY: ClassVar[uint8] = 7
    POWER_SUPPLY_TECHNOLOGY_VRLA: ClassVar[uint8] = 8

    header: Header
    voltage: float32
    temperature: float32
    current: float32
    charge: float32
    capacity: float32
    design_capacity: float32
    percentage: float32
    power_supply_status: uint8
    power_supply_health: uint8
    power_supply_technology: uint8
    present: bool
    cell_voltage: Sequence[float32]
    cell_temperature: Sequence[float32]
    location: string
    serial_number: string
