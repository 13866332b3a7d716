//! The numbers that a gait's three curves are made of, as records keep them.

use serde::{Deserialize, Serialize};

use prone::gait::{Curve, CurveForm, Gait};

/// θ3, θ4 and α over the phase s, rad.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CurvesInfo {
    /// θ3, the knee.
    pub knee: CurveInfo,
    /// θ4, the hip.
    pub hip: CurveInfo,
    /// α, the upper arm.
    pub upper_arm: CurveInfo,
}

/// One curve.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "form", rename_all = "kebab-case")]
pub enum CurveInfo {
    /// A polynomial of s.
    Polynomial {
        /// Coefficient of the highest power first, rad.
        coefficients_rad: Vec<f64>,
    },
    /// A clamped uniform B-spline.
    BSpline {
        /// Its degree.
        degree: usize,
        /// Control points, rad.
        control_rad: Vec<f64>,
    },
    /// A natural cubic spline.
    Through {
        /// Points (s, rad).
        points: Vec<(f64, f64)>,
    },
}

impl CurvesInfo {
    /// Of a gait.
    pub fn of(gait: &Gait) -> Self {
        Self {
            knee: CurveInfo::of(&gait.knee),
            hip: CurveInfo::of(&gait.hip),
            upper_arm: CurveInfo::of(&gait.upper_arm),
        }
    }

    /// θ3, θ4, α.
    pub fn to_array(&self) -> [&CurveInfo; 3] {
        [&self.knee, &self.hip, &self.upper_arm]
    }
}

impl CurveInfo {
    fn of(curve: &Curve) -> Self {
        match curve.form() {
            CurveForm::Polynomial(coefficients) => Self::Polynomial {
                coefficients_rad: coefficients.clone(),
            },
            CurveForm::BSpline { degree, control } => Self::BSpline {
                degree: *degree,
                control_rad: control.clone(),
            },
            CurveForm::Through(points) => Self::Through {
                points: points.clone(),
            },
        }
    }
}
