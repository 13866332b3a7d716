//! What motors did in a time.

use crate::robot::{Drive, Robot};

/// What the motors of a robot did.
#[derive(Debug, Clone, PartialEq)]
pub struct Effort {
    /// Over which time, s.
    pub seconds: f64,
    /// For how much of it the commands moved, s; the rest of it was rest.
    pub moving: f64,
    /// By [`Robot::drives`].
    pub motors: Vec<MotorEffort>,
}

/// What one motor did. Torque τ is **applied torque**: what the motor gave at the joint over a step,
/// its back-EMF taken off; of a motor that turns several joints, their sum.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MotorEffort {
    /// ∫ τ² dt, N²·m²·s.
    pub square: f64,
    /// ∫ max(P, 0) dt, J, with its power P: a motor is not given back what it brakes.
    pub work: f64,
    /// Largest |τ|, N·m.
    pub peak: f64,
    /// For how much of [`Effort::moving`] its controller asked for more than the supply gives, s.
    pub supply_clipped: f64,
    /// For how much of [`Effort::moving`] the current limit cut what the supply would have given, s.
    pub current_limited: f64,
    /// Largest |position error| that its controller went by, rad; of several joints, their mean's.
    pub largest_lag: f64,
    /// Largest speed of its joints that was commanded, rad/s.
    pub planned_speed: f64,
}

/// Whether commands move. How well motors follow is a question of the time in which they do: a rest
/// lets them cool, and makes them no stronger.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Commands {
    /// They change from one command step to the next.
    Move,
    /// They have been the same for longer than that.
    Rest,
}

/// What one motor does in one engine step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotorStep {
    /// **Applied torque**, N·m; of several joints, their sum.
    pub torque: f64,
    /// Torque times speed at mid-step, W; of several joints, their sum.
    pub power: f64,
    /// |Position error| that its controller went by, rad; of several joints, their mean.
    pub lag: f64,
    /// Whether its controller asked for more than the supply gives.
    pub supply_clipped: bool,
    /// Whether the current limit cut what the supply would have given.
    pub current_limited: bool,
}

/// What a motor did, in terms of what it can do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotorUse {
    /// ∫ (τ / nominal torque)² dt, s, before gear losses.
    pub heat: f64,
    /// √(∫ τ² dt / time) over what the gear passes on of the nominal torque.
    pub rms_over_nominal: f64,
    /// Largest commanded speed over the no-load speed.
    pub planned_over_no_load: f64,
    /// What the winding loses, J, before gear losses ([`crate::robot::Motor::winding_loss`]).
    pub winding_loss: f64,
}

/// A motor of which too little is known.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "joint {joint} has no motor with all of its figures in robot.toml (ratio, nominal and stall torque, no-load speed), without which its load is not known"
)]
pub struct UnknownMotor {
    /// Name of the joint.
    pub joint: String,
}

impl MotorEffort {
    /// Adds a step of some length, s, in which commands moved or rested.
    pub fn add_step(&mut self, step: &MotorStep, seconds: f64, commands: Commands) {
        self.square += step.torque * step.torque * seconds;
        self.work += step.power.max(0.0) * seconds;
        self.peak = self.peak.max(step.torque.abs());
        self.largest_lag = self.largest_lag.max(step.lag);
        if step.supply_clipped && commands == Commands::Move {
            self.supply_clipped += seconds;
        }
        if step.current_limited && commands == Commands::Move {
            self.current_limited += seconds;
        }
    }

    fn add(&mut self, other: &Self) {
        self.square += other.square;
        self.work += other.work;
        self.peak = self.peak.max(other.peak);
        self.supply_clipped += other.supply_clipped;
        self.current_limited += other.current_limited;
        self.largest_lag = self.largest_lag.max(other.largest_lag);
        self.planned_speed = self.planned_speed.max(other.planned_speed);
    }

    /// √(∫ τ² dt / time), N·m.
    pub fn rms(&self, seconds: f64) -> f64 {
        (self.square / seconds).sqrt()
    }

    /// ∫ (τ / nominal torque)² dt of a motor of a robot, s, before gear losses.
    ///
    /// # Errors
    /// [`UnknownMotor`] where its figures are not known.
    pub fn heat(&self, robot: &Robot, drive: &Drive) -> Result<f64, UnknownMotor> {
        // Neither time nor gear is in it.
        self.motor_use(robot, drive, 1.0, 1.0).map(|it| it.heat)
    }

    /// What a motor of a robot did over a time, s, behind a gear of some efficiency.
    ///
    /// # Errors
    /// [`UnknownMotor`] where its figures are not known.
    pub fn motor_use(
        &self,
        robot: &Robot,
        drive: &Drive,
        seconds: f64,
        gear_efficiency: f64,
    ) -> Result<MotorUse, UnknownMotor> {
        let joint = drive.named_after(robot);
        let known = joint
            .motor
            .and_then(|motor| Some((motor, motor.no_load_speed?, motor.winding_loss()?)));
        let (motor, no_load, loss) = known.ok_or_else(|| UnknownMotor {
            joint: joint.name.clone(),
        })?;
        Ok(MotorUse {
            heat: self.square / (motor.nominal * motor.nominal),
            rms_over_nominal: self.rms(seconds) / (gear_efficiency * motor.nominal),
            planned_over_no_load: self.planned_speed / no_load,
            winding_loss: self.square * loss,
        })
    }
}

impl Effort {
    /// Of a robot that has done nothing yet.
    pub fn none(robot: &Robot) -> Self {
        Self {
            seconds: 0.0,
            moving: 0.0,
            motors: vec![MotorEffort::default(); robot.drives().len()],
        }
    }

    /// What each motor did, with the joints that it turns.
    ///
    /// # Panics
    /// Where it is the effort of a robot with another number of motors.
    pub fn by_drive(&self, robot: &Robot) -> Vec<(Drive, &MotorEffort)> {
        let drives = robot.drives();
        assert_eq!(drives.len(), self.motors.len(), "efforts of another robot");
        drives.into_iter().zip(&self.motors).collect()
    }

    /// Adds what every motor did in a step of some length, s, while commands moved or rested.
    pub fn add_step(&mut self, steps: &[MotorStep], seconds: f64, commands: Commands) {
        self.seconds += seconds;
        if commands == Commands::Move {
            self.moving += seconds;
        }
        for (motor, step) in self.motors.iter_mut().zip(steps) {
            motor.add_step(step, seconds, commands);
        }
    }

    /// Share that a part of [`Self::moving`] has in it; 0 where nothing moved.
    pub fn of_moving(&self, seconds: f64) -> f64 {
        if self.moving > 0.0 {
            seconds / self.moving
        } else {
            0.0
        }
    }

    /// Adds what was done in another time.
    pub fn add(&mut self, other: &Self) {
        self.seconds += other.seconds;
        self.moving += other.moving;
        for (motor, other) in self.motors.iter_mut().zip(&other.motors) {
            motor.add(other);
        }
    }

    /// ∫ Σ (τ / nominal torque)² dt, s: in proportion to the heat of the windings.
    ///
    /// # Errors
    /// [`UnknownMotor`]: the heat of some motors is not that of the robot.
    pub fn heat(&self, robot: &Robot) -> Result<f64, UnknownMotor> {
        let motors = self.by_drive(robot).into_iter();
        motors.map(|(drive, motor)| motor.heat(robot, &drive)).sum()
    }

    /// ∫ Σ max(P, 0) dt, J.
    pub fn work(&self) -> f64 {
        self.motors.iter().map(|motor| motor.work).sum()
    }

    /// The largest |τ| over the effort limit, and the joint that its motor is named after.
    pub fn peak_over_limit(&self, robot: &Robot) -> (f64, String) {
        let motors = self.by_drive(robot).into_iter();
        let shares = motors.map(|(drive, motor)| {
            let joint = drive.named_after(robot);
            (motor.peak / joint.effort_limit, &joint.name)
        });
        let most = shares.reduce(|best, next| if next.0 > best.0 { next } else { best });
        most.map_or((0.0, String::new()), |(share, name)| (share, name.clone()))
    }
}

impl Robot {
    /// Checks that the figures of all motors are known, without which a robot has no heat.
    ///
    /// # Errors
    /// [`UnknownMotor`], the first one.
    pub fn check_motors(&self) -> Result<(), UnknownMotor> {
        Effort::none(self).heat(self).map(|_| ())
    }
}

#[cfg(test)]
mod tests;
